#include "program/progress_line.hpp"

#include <gtest/gtest.h>

namespace graze::progress_line_test {

TEST(ProgressLine, CountsPointsOfTheRunAndOfTheStudy) {
    StudyProgress progress;
    progress.run = "down";
    progress.done = 30;
    progress.points = 200;
    progress.study_done = 230;
    progress.study_points = 400;
    EXPECT_EQ(progress_text(progress, std::nullopt), "down: 30 of 200 points; study: 230 of 400, 58 %");
    EXPECT_EQ(progress_text(progress, TimeLeft::Estimate{12.4, false}),
              "down: 30 of 200 points; study: 230 of 400, 58 %, 12 s left");
    EXPECT_EQ(progress_text(progress, TimeLeft::Estimate{12.4, true}),
              "down: 30 of 200 points; study: 230 of 400, 58 %, more than 12 s left");
    progress.study_done = 30;
    progress.study_points = 200;
    progress.branches_left = 1; // of unknown length
    EXPECT_EQ(progress_text(progress, TimeLeft::Estimate{3, false}),
              "down: 30 of 200 points, 15 %, more than 3 s left");
}

} // namespace graze::progress_line_test
