// Studies with runs of the kinds record and identify: output, exported tables and exit codes.

#include "base/temporary_folder.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace graze::testing::run_measured_test {

using ::testing::HasSubstr;

const char* const study = R"(name = "releases"
model = "electromagnetic-testbed"
[runs.releases]
kind = "record"
set = { V0 = 0, w0 = 90 }
from = { q = -0.7e-3 }
[runs.releases.bench]
channels = { v = { value = "v", noise = 1e-4 } }
rate = 1000
time = 1.5
repeats = 3
[runs.decay]
kind = "identify"
what = "decrement"
records = "releases"
gives = { natural_frequency = "w0", damping_ratio = "zeta" }
)";

TEST(RunMeasured, EstimatesArePrintedStoredAndExported) {
    const TemporaryFolder folder;
    const std::string file = folder.write("s.toml", study);
    const Printed run = run_graze({"run", file, "--output", folder / "out", "--no-pictures"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("ended 3"));
    EXPECT_THAT(run.out, HasSubstr("w0 = 90.0")); // the value of the bench, with an error of about 0.01
    EXPECT_THAT(run_graze({"export", folder / "out", "--sql",
                           "SELECT name FROM estimates WHERE low < 90 AND high > 90 AND name = 'w0'"})
                    .out,
                HasSubstr("w0"));
    done({"export", folder / "out", "--format", "hdf5", "--output", folder / "out.h5"});
    const std::string info = done({"info", folder / "out"});
    EXPECT_THAT(info, HasSubstr("identify"));
    // The result file alone is enough to repeat everything.
    const std::string again = done({"run", folder / "out", "--output", folder / "again", "--no-pictures"});
    EXPECT_THAT(again, HasSubstr("w0 = 90.0"));
}

TEST(RunMeasured, UnreadableRecordsAreRefused) {
    const TemporaryFolder folder;
    folder.write("a.csv", "t,V\n0,1\n1,one\n");
    const std::string head = "name = \"s\"\n[runs.a]\nkind = \"record\"\n";
    expect_refusal({"run", folder.write("o.toml", head + "files = \"../a.csv\"\n"), "--output", folder / "o"},
                   "o.toml:4:10: the record '../a.csv' would be outside");
    const Printed wrong =
        run_graze({"run", folder.write("w.toml", head + "files = \"a.csv\"\n"), "--output", folder / "w"});
    EXPECT_NE(wrong.code, 0);
    EXPECT_THAT(wrong.err, HasSubstr("a.csv:3:"));
}

} // namespace graze::testing::run_measured_test
