#include "page/json_text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace graze {
namespace {

TEST(JsonText, HasNoBytesThatAreNotUtf8) {
    const std::string text = json_text({{"na\xffme", "a\xc3(b"}});
    EXPECT_EQ(text, "{\"na\xEF\xBF\xBDme\":\"a\xEF\xBF\xBD(b\"}");
    EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(JsonText, EndsNoScriptInWhichItStands) {
    const nlohmann::json hostile{{"</script><script>alert(1)</script>", "<!-- \" ' &"}};
    const std::string text = json_text(hostile);
    EXPECT_EQ(text.find('<'), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(text), hostile);
}

TEST(JsonText, WritesNumbersThatReadBackToTheSame) {
    const std::array<double, 4> numbers{0.1, -1.0 / 3, 5e-324, 1.7976931348623157e308};
    const nlohmann::json back = nlohmann::json::parse(json_text(numbers_json(numbers)));
    for (std::size_t i = 0; i < numbers.size(); ++i)
        EXPECT_EQ(back[i].get<double>(), numbers[i]);
}

TEST(JsonText, HasNullForWhatIsNoNumber) {
    const std::array<double, 4> numbers{1, std::numeric_limits<double>::quiet_NaN(),
                                        std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity()};
    EXPECT_EQ(json_text(numbers_json(numbers)), "[1.0,null,null,null]");
}

} // namespace
} // namespace graze
