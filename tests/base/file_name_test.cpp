#include "graze/base/file_name.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace graze::file_name_test {

TEST(FileName, IsSafeInPathsAndCommands) {
    for (const char* name : {"a", "fig-5-14d", "a.b", "A_1", "0"})
        EXPECT_TRUE(is_file_name(name)) << name;
    for (const std::string& name :
         {std::string(),       std::string("."),    std::string(".."),      std::string("../a"),
          std::string("a/b"),  std::string("/a"),   std::string(".a"),      std::string("-a"),
          std::string("a b"),  std::string("a\nb"), std::string("a\0b", 3), std::string("ä"),
          std::string("a\\b"), std::string("a:b"),  std::string("`a`"),     std::string("a;b"),
          std::string("a'b"),  std::string("a\"b"), std::string("$a"),      std::string(101, 'a')}) {
        EXPECT_FALSE(is_file_name(name)) << name;
        EXPECT_THROW(require_file_name(name, "name", {}), InputError) << name;
    }
    std::mt19937 random(3);
    for (int i = 0; i < 20'000; ++i) {
        std::string name;
        for (int letter = 0; letter < 6; ++letter)
            name += static_cast<char>(std::uniform_int_distribution<>(0, 255)(random));
        if (!is_file_name(name))
            continue;
        EXPECT_EQ(name.find_first_of("/\\ \n\t'\"`$;&|<>*?~:"), std::string::npos) << name;
    }
}

} // namespace graze::file_name_test
