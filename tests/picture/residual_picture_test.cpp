#include "graze/picture/result_picture.hpp"

#include "graze/study/runner.hpp"

#include "base/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::testing::residual_picture_test {

// Residuals are measured less fitted values.
TEST(ResidualPicture, ShowsMeasuredValuesAndResiduals) {
    const TemporaryFolder folder;
    std::string text = "t [s], v [m/s]\n";
    for (int i = 0; i < 1500; ++i) {
        const double t = i / 1000.0;
        text += fmt::format("{:.17g},{:.17g}\n", t, 0.07 * std::exp(-1.5 * t) * std::sin(95.9 * t));
    }
    folder.write("release.csv", text);
    const Study study = read_study(folder.write("s.toml", R"(name = "s"
model = "electromagnetic-testbed"
[runs.release]
kind = "record"
files = "release.csv"
[runs.decay]
kind = "identify"
what = "decrement"
records = "release"
gives = { natural_frequency = "w0", damping_ratio = "zeta" }
)"));
    ResultFile file(folder / "results.sqlite", ResultFile::Access::write);
    for (const RunReport& report : run_study(study, file, {}))
        ASSERT_TRUE(report.complete()) << report.name << ": " << report.problem;
    const Figure figure = make_picture(default_picture(*file.find_run("decay")), file).figure;
    ASSERT_EQ(figure.panels.size(), 2U);
    const std::vector<PlanePoint>&measured = figure.panels[0].series[0].points,
          &fitted = figure.panels[0].series[1].points, &left = figure.panels[1].series[0].points;
    ASSERT_EQ(measured.size(), 10U) << "peaks";
    for (std::size_t i = 0; i < measured.size(); ++i)
        EXPECT_NEAR(left[i].y, measured[i].y - fitted[i].y, 1e-15);
}

} // namespace graze::testing::residual_picture_test
