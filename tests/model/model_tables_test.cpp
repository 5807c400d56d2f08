// Tables of a model: functions that are given by points, in the model or in a file beside it.

#include "base/temporary_folder.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/model/model_file.hpp"
#include "graze/symbolic/piece_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace graze::model_tables_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string model_with(const std::string& table) {
    return "states = { x = 1, s = 0 }\n"
           "modes.free = { rates = { x = 'f(s) - x', s = 1 } }\n"
           "tables.f = { " +
           table + " }\n";
}

class ModelTables : public ::testing::Test {
protected:
    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories(std::filesystem::path(at(name)).parent_path());
        std::ofstream(at(name)) << text;
    }
    std::string at(const std::string& name) const { return folder_.path() + "/" + name; }
    Model read(const std::string& table) const {
        write("model.toml", model_with(table));
        return read_model(at("model.toml"));
    }
    /// Returns the message of a mistake without the folder.
    std::string mistake(const std::string& table) const {
        try {
            read(table);
        } catch (const InputError& error) {
            std::string said = error.what();
            for (std::size_t found; (found = said.find(folder_.path() + "/")) != std::string::npos;)
                said.erase(found, folder_.path().size() + 1);
            return said;
        }
        return "";
    }
    /// The same for a table in a file.
    std::string mistake_in(const std::string& text) const {
        write("f.csv", text);
        return mistake("file = 'f.csv'");
    }

    graze::testing::TemporaryFolder folder_;
};

TEST_F(ModelTables, AreReadFromPointsAndFiles) {
    const std::vector<PieceTable::Point> points{{0, 1}, {0.5, -2}, {2, 1e-3}};
    write("data/f.csv", "# a force\nt [s],x,f\n0,7,1\n0.5,8,-2\n\n2,9,1e-3\n");
    write("plain.txt", "0 1\r\n0.5\t-2\r\n 2 +1e-3");
    for (const char* table : {"points = [[0, 1], [0.5, -2], [2, 1e-3]]",
                              "file = 'data/f.csv', columns = ['t [s]', 'f']", "file = 'plain.txt'"}) {
        const Model model = read(table);
        ASSERT_EQ(model.graph->tables().size(), 1u) << table;
        EXPECT_EQ(model.graph->tables().front()->points(), points) << table;
        EXPECT_EQ(model.graph->tables().front()->options(), PieceTable::Options{}) << table;
    }
}

TEST_F(ModelTables, AreWrittenWithTheirPoints) {
    write("f.csv", "0,1\n0.1,-2\n2,1\n");
    for (const char* options : {"", ", interpolation = 'cubic', periodic = true, text = 'a force'",
                                ", outside = 'error'", ", outside = 'linear'"}) {
        const Model model = read(std::string("file = 'f.csv'") + options);
        const std::string text = write_model(model);
        const Model again = parse_model(text, "again.toml");
        EXPECT_TRUE(*again.graph->tables().front() == *model.graph->tables().front()) << text;
        EXPECT_EQ(write_model(again), text);
    }
}

TEST_F(ModelTables, AreCopiedWithTheModel) {
    Model model = read("points = [[0, 1], [1, 3]]");
    const Model copy = model;
    model = Model();
    EXPECT_DOUBLE_EQ(copy.function_of(copy.modes.front().rates)(std::vector{1.0, 0.5})[0], 1);
}

TEST_F(ModelTables, MistakesOfTheModelHaveTheirPlace) {
    EXPECT_THAT(mistake("points = [[0, 1]]"), StartsWith("model.toml:3:23: table 'f' has 1 points"));
    EXPECT_THAT(mistake("points = [[0, 1], [0, 2]]"),
                StartsWith("model.toml:3:32: the abscissae of tables.f.points do not increase: 0 follows 0"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, nan]]"), HasSubstr("model.toml:3:36: tables.f.points.2.2 is nan"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 'x']]"), StartsWith("model.toml:3:36: "));
    EXPECT_THAT(mistake("points = [[0, 1, 2], [1, 2, 3]]"),
                StartsWith("model.toml:3:24: tables.f.points.1 has 3 numbers"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 2]], periodic = true"),
                HasSubstr("the periodic table 'f' begins with the value 1 and ends with 2"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 1]], periodic = true, outside = 'hold'"),
                HasSubstr("tables.f is periodic: nothing is outside"));
    EXPECT_THAT(mistake("interpolation = 'cubic'"), HasSubstr("tables.f needs either points or a file"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 1]], interpolation = 'square'"),
                HasSubstr("tables.f.interpolation cannot be 'square'"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 1]], colums = ['x', 'f']"), HasSubstr("colums"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 1]], columns = ['x', 'f']"), HasSubstr("has columns but no file"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 1]] }\nparameters = { f = 3"), HasSubstr("the name 'f' is used twice"));
    EXPECT_THAT(mistake("points = [[0, 1], [1, 1]] }\nquantities = { q = 'f + 1'"),
                HasSubstr("the function 'f' has no argument"));
}

TEST_F(ModelTables, MistakesOfFilesHaveTheirPlace) {
    EXPECT_THAT(mistake_in(""), StartsWith("f.csv: the table has 0 rows of numbers"));
    EXPECT_THAT(mistake_in("x,f\n1,2\n"), StartsWith("f.csv: the table has 1 rows of numbers"));
    EXPECT_THAT(mistake_in("x,f\n1,2\n3,abc\n"), StartsWith("f.csv:3:3: 'abc' is not a number"));
    EXPECT_THAT(mistake_in("x,f\n1,2\n3, nan\n"), StartsWith("f.csv:3:4: 'nan' is not a finite number"));
    EXPECT_THAT(mistake_in("1,2\n3,\n"), StartsWith("f.csv:2:3: '' is not a number"));
    EXPECT_THAT(mistake_in("1,2\n3\n"), StartsWith("f.csv:2: the row has 1 of at least 2 numbers"));
    EXPECT_THAT(mistake_in("1,2\n3,4\n3,5\n"), StartsWith("f.csv:3:1: the abscissae do not increase: 3 follows 3"));
    std::string many;
    for (std::size_t i = 0; i <= PieceTable::most_points; ++i)
        many += std::to_string(i) + ",0\n";
    EXPECT_THAT(mistake_in(many), StartsWith("f.csv:1000001: the table has more than 1000000 rows"));
    write("f.csv", "x,f\n1,2\n3,4\n");
    EXPECT_THAT(mistake("file = 'f.csv', columns = ['x', 'g']"), StartsWith("f.csv:1:1: there is no column 'g'"));
    EXPECT_THAT(mistake("file = 'f.csv', columns = ['x']"), HasSubstr("tables.f.columns names 1 columns"));
    EXPECT_THAT(mistake("file = 'g.csv'"), HasSubstr("g.csv"));
}

TEST_F(ModelTables, FilesAreInsideTheFolderOfTheModel) {
    const testing::TemporaryFolder other;
    const std::string outside = other.path() + "/f.csv";
    std::ofstream(outside) << "0,1\n1,2\n";
    EXPECT_THAT(mistake("file = '" + outside + "'"), HasSubstr("is not inside the folder of the model"));
    EXPECT_THAT(mistake("file = '../" + other.path().substr(other.path().rfind('/') + 1) + "/f.csv'"),
                HasSubstr("is not inside the folder of the model"));
    std::filesystem::create_symlink(outside, at("link.csv"));
    EXPECT_THAT(mistake("file = 'link.csv'"),
                StartsWith("model.toml:3:21: 'link.csv' is not inside the folder of the model"));
    EXPECT_THAT(mistake("file = ''"), HasSubstr("is not inside the folder of the model"));
    EXPECT_THAT(mistake("file = 'absent.csv'"), StartsWith("model.toml:3:21: the file 'absent.csv' does not exist"));
    EXPECT_THAT(mistake("file = 'no/folder/f.csv'"), HasSubstr("the file 'no/folder/f.csv' does not exist"));
    // A text that is not in a file has no folder.
    EXPECT_THROW(parse_model(model_with("file = 'f.csv'"), "f.toml"), InputError);
}

} // namespace graze::model_tables_test
