#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

namespace graze::input_error_test {

TEST(InputError, WorksWithoutPlaceOrRemedy) {
    EXPECT_STREQ(InputError("no such state", "").what(), "no such state");
    EXPECT_STREQ(InputError("no such state", "see the model").what(), "no such state; see the model");
}

TEST(FileError, IsAnInputErrorWhosePlaceIsTheFile) {
    const FileError error("results.sqlite", "it cannot be read", "check the path");
    EXPECT_STREQ(static_cast<const InputError&>(error).what(), "results.sqlite: it cannot be read; check the path");
    EXPECT_EQ(error.kind(), ErrorKind::file);
}

} // namespace graze::input_error_test
