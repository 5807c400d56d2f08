#include "graze/model/parameter_file.hpp"

#include <gmock/gmock.h>

namespace graze::testing::parameter_file_test {

TEST(ParameterFile, ReadsBackUnchanged) {
    ParameterFile file;
    file.model = "impact-oscillator";
    file.text = "found by \"fit\"\nfrom two records";
    file.set = {{"e", 0.1 + 0.2}, {"k", 3}, {"tiny", 1e-300}, {"large", -1e300}};
    file.from = {{"x", -1.0 / 3}};
    file.errors = {{"e", 1e-9}};
    const ParameterFile again = parse_parameter_file(write_parameter_file(file), "found.toml");
    EXPECT_EQ(again.model, file.model);
    EXPECT_EQ(again.text, file.text);
    EXPECT_EQ(again.errors, file.errors);
    EXPECT_EQ(again.from, file.from);
    auto sorted = file.set;
    std::sort(sorted.begin(), sorted.end());
    auto read = again.set;
    std::sort(read.begin(), read.end());
    EXPECT_EQ(read, sorted);
}

TEST(ParameterFile, MistakesHaveAPlace) {
    for (const auto& [text, message] : {std::pair("[set]\ne = \"a\"\n", "f.toml:2:5: "),
                                        std::pair("[set]\ne = nan\n", "f.toml:2:5: 'e' is not finite"),
                                        std::pair("sets = 1\n", "f.toml:1:1: "), std::pair("[set\n", "f.toml:1:")})
        try {
            parse_parameter_file(text, "f.toml");
            ADD_FAILURE() << text;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), ::testing::StartsWith(message)) << text;
            EXPECT_THAT(error.what(), ::testing::HasSubstr(";")) << text;
        }
}

} // namespace graze::testing::parameter_file_test
