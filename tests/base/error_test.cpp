#include "graze/base/error.hpp"

#include "graze/base/input_errors.hpp"
#include "graze/base/with_place.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace graze::error_test {

TEST(Place, TextLeavesOutWhatIsNotKnown) {
    EXPECT_EQ((Place{"model.toml", 3, 7}.text()), "model.toml:3:7");
    EXPECT_EQ((Place{"model.toml", 3, 0}.text()), "model.toml:3");
    EXPECT_EQ((Place{"model.toml", 0, 0}.text()), "model.toml");
    EXPECT_EQ((Place{"model.toml", 0, 7}.text()), "model.toml") << "a column means nothing without its line";
    EXPECT_EQ((Place{"", 3, 7}.text()), "3:7");
    EXPECT_EQ(Place{}.text(), "");
}

TEST(Error, SaysPlaceProblemAndRemedyOnOneLine) {
    const Error error(ErrorKind::instrument, Place{"model.toml", 3, 7}, "unknown name 'a'", "did you mean 'b'?");
    EXPECT_STREQ(error.what(), "model.toml:3:7: unknown name 'a'; did you mean 'b'?");
    EXPECT_EQ(error.kind(), ErrorKind::instrument);
    EXPECT_EQ(error.place().line, 3);
    EXPECT_EQ(error.problem(), "unknown name 'a'");
    EXPECT_EQ(error.remedy(), "did you mean 'b'?");
}

TEST(Error, HasAKindHoweverItIsCaught) {
    const auto kind_of = [](const std::function<void()>& work) {
        try {
            work();
        } catch (const Error& error) {
            return name_of(error.kind());
        }
        return std::string_view();
    };
    EXPECT_EQ(kind_of([] { throw InputError("a", "b"); }), "input");
    EXPECT_EQ(kind_of([] { throw FileError("results.sqlite", "a", "b"); }), "file");
    EXPECT_EQ(kind_of([] { throw OrderError("a"); }), "order");
    EXPECT_EQ(kind_of([] { throw InternalError("a"); }), "internal");
    EXPECT_EQ(name_of(ErrorKind::instrument), "instrument");
    // A file that cannot be read is one of several mistakes, and stays what it is.
    Mistakes mistakes;
    mistakes.attempt([] { throw FileError("results.sqlite", "a", "b"); });
    EXPECT_EQ(kind_of([&] { mistakes.throw_noted(); }), "file");
    EXPECT_EQ(kind_of([] {
                  with_place({"study.toml", 1, 1}, [] { throw FileError("results.sqlite", "a", "b"); });
              }),
              "file");
}

} // namespace graze::error_test
