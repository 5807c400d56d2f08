#include "graze/model/catalogue.hpp"

#include "base/message_of.hpp"
#include "graze/model/check.hpp"
#include "graze/model/model_file.hpp"
#include "places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace graze::catalogue_test {

std::string message(const std::string& name) {
    return testing::message_of([&] { load_model(name); });
}

TEST(Catalogue, HoldsTheFilesOfModelsUnchanged) {
    std::set<std::string> files;
    for (const auto& file : std::filesystem::directory_iterator(std::string(testing::source_folder) + "/models"))
        if (file.path().extension() == ".toml") {
            files.insert(file.path().stem().string());
            std::ostringstream text;
            text << std::ifstream(file.path(), std::ios::binary).rdbuf();
            const auto entry = find_in_catalogue(file.path().stem().string());
            ASSERT_TRUE(entry) << file.path();
            EXPECT_EQ(entry->text, text.str()) << file.path();
        }
    EXPECT_EQ(files.size(), catalogue().size());
    EXPECT_FALSE(files.empty());
}

TEST(Catalogue, IsSortedAndHasSummaries) {
    EXPECT_TRUE(std::is_sorted(catalogue().begin(), catalogue().end(),
                               [](const auto& one, const auto& other) { return one.name < other.name; }));
    for (const CatalogueEntry& entry : catalogue()) {
        EXPECT_FALSE(entry.summary.empty()) << entry.name;
        EXPECT_EQ(entry.summary.find('\n'), std::string::npos) << entry.name;
    }
}

TEST(Catalogue, ShippedModelsAreValidDocumentedAndReadBack) {
    for (const CatalogueEntry& entry : catalogue()) {
        SCOPED_TRACE(entry.name);
        const Model model = load_model(entry.name);
        EXPECT_EQ(model.name, entry.name);
        EXPECT_FALSE(model.source.empty());
        for (const Parameter& parameter : model.parameters)
            EXPECT_FALSE(parameter.text.empty()) << parameter.name;
        for (const std::string& warning : model_warnings(model))
            ADD_FAILURE() << warning;
        const std::string written = write_model(model);
        EXPECT_EQ(write_model(parse_model(written, "written.toml")), written);
    }
}

TEST(Catalogue, LoadsByNameOrPath) {
    const std::string name = catalogue().front().name;
    EXPECT_EQ(load_model(std::string(testing::source_folder) + "/models/" + name + ".toml").name, name);
    EXPECT_FALSE(find_in_catalogue("nothing-like-it"));
    EXPECT_EQ(load_model("microbeam-3").name, "microbeam-3");
    EXPECT_EQ(load_model("microbeam-12").states.size(), 25u);
    for (const char* none : {"microbeam-", "microbeam-0", "microbeam-1", "microbeam-03", "microbeam-3x", "microbeam--3",
                             "microbeam-3.0", "microbeam-99999999999"})
        EXPECT_NE(message(none).find("there is no shipped model"), std::string::npos) << none;
    EXPECT_NE(message("microbeam-201").find("the number of modes is 201"), std::string::npos);
    std::string wrong = name;
    wrong.back() = '_';
    EXPECT_NE(message(wrong).find("there is no shipped model '" + wrong + "'; did you mean '" + name + "'?"),
              std::string::npos)
        << message(wrong);
    EXPECT_NE(message("nowhere.toml").find("nowhere.toml: the model file cannot be read"), std::string::npos);
    EXPECT_NE(message("./nowhere").find("cannot be read"), std::string::npos);
}

} // namespace graze::catalogue_test
