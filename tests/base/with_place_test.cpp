#include "graze/base/with_place.hpp"

#include <gtest/gtest.h>

namespace graze::with_place_test {

InputError mistake_of(const InputError& found, const std::string& about = {}) {
    try {
        with_place(
            {"a.toml", 3, 4}, [&]() -> int { throw found; }, about);
    } catch (const InputError& error) {
        return error;
    }
    return InputError("none", "");
}

TEST(WithPlace, GivesAPlaceToErrorsWithoutOne) {
    const InputError error = mistake_of(InputError("it is wrong", "mend it"), "run 'a': ");
    EXPECT_EQ(error.place().file, "a.toml");
    EXPECT_EQ(error.place().line, 3);
    EXPECT_EQ(error.problem(), "run 'a': it is wrong");
    EXPECT_EQ(error.remedy(), "mend it");
}

TEST(WithPlace, KeepsOtherPlacesAndReturnsTheResult) {
    const InputError error = mistake_of(InputError({"b.toml", 1, 2}, "it is wrong", "mend it"), "run 'a': ");
    EXPECT_EQ(error.place().file, "b.toml");
    EXPECT_EQ(error.problem(), "it is wrong");
    EXPECT_EQ(with_place({}, [] { return 7; }), 7);
}

} // namespace graze::with_place_test
