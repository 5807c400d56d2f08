#include "run_graze.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <sys/resource.h>

namespace graze::testing::many_parts_test {

TEST(ManyParts, AreMergedThoughFewFilesMayBeOpenAtFirst) {
    const Folder folder;
    const std::string study = folder.write("study.toml", "name = \"s\"\nmodel = \"bouncing-ball\"\n[runs.r]\nkind = "
                                                         "\"simulate\"\ntime = 1\n");
    done({"run", study, "--output", folder / "a", "--part", "1/1", "--quiet"});
    for (int copy = 0; copy < 100; ++copy)
        std::filesystem::copy_file(folder / "a/parts/1-of-1.sqlite",
                                   folder / ("a/parts/copy-" + std::to_string(copy) + ".sqlite"));
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    const rlimit few{64, before.rlim_max};
    setrlimit(RLIMIT_NOFILE, &few);
    const Printed printed = run_graze({"merge", folder / "a", "--no-pictures"});
    setrlimit(RLIMIT_NOFILE, &before);
    EXPECT_EQ(printed.code, exit_success) << printed.err;
}

} // namespace graze::testing::many_parts_test
