// Result files and queries from untrusted sources.

#include "graze/base/input_error.hpp"
#include "graze/results/query_interruption.hpp"

#include "base/temporary_folder.hpp"
#include "run_of_model.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <random>
#include <string>

namespace graze::hostile_file_test {

using namespace std::chrono_literals;

constexpr const char* oscillator = R"(
name = "oscillator"
[states]
x = 1
v = 0
[modes.only]
rates = { x = "v", v = "-x" }
)";

class HostileFile : public ::testing::Test {
protected:
    HostileFile() {
        write();
        image = testing::contents(path);
    }
    static RunRecord run_named(const std::string& name) {
        RunRecord run = testing::run_of(parse_model(oscillator, "oscillator"), name, "basin");
        run.settings = "{}";
        run.coordinates = {{"x", "m"}};
        run.values = {{"v", ""}};
        run.samplings = {"s"};
        run.points = 20;
        return run;
    }
    static PointRecord point_numbered(std::size_t number) {
        PointRecord point;
        point.number = number;
        point.coordinates = {static_cast<double>(number)};
        point.result.label = Label::periodic;
        point.result.state = {1, 2};
        point.result.samples.width = 1;
        for (int s = 0; s < 5; ++s) {
            point.result.samples.samplings.push_back(0);
            point.result.samples.times.push_back(s);
            point.result.samples.values.push_back(s);
        }
        return point;
    }
    void write() const {
        ResultFile file(path, ResultFile::Access::write);
        file.begin_run(run_named("r"));
        for (std::size_t number = 0; number < 20; ++number)
            file.add_point("r", point_numbered(number));
        file.complete_run("r");
    }
    /// Creates the file again, and changes it by SQL statements of another program.
    void tamper(const std::string& sql) const {
        restore(image);
        testing::change(path, sql);
    }
    void restore(const std::string& bytes) const { folder.write("results.sqlite", bytes); }

    /// Reads everything that the program reads of a file. @return the message if it is refused by an InputError
    std::string refusal() const {
        std::string message;
        const auto attempt = [&](auto read) {
            try {
                read();
            } catch (const InputError& error) {
                message = error.what();
            }
        };
        attempt([&] {
            ResultFile file(path, ResultFile::Access::read);
            file.set_patience(200ms);
            for (const RunRecord& run : file.runs()) {
                attempt([&] { stored_model(run); });
                attempt([&] {
                    for (const auto next = file.last_points(run.name, 5); next();) {
                    }
                });
                attempt([&] { file.point(run.name, 3); });
                attempt([&] { file.nearest_point(run.name, "x", 3, std::nullopt); });
                attempt([&] { file.orbits(run.name, false); });
            }
            for (const char* sql :
                 {"SELECT * FROM all_points", "SELECT * FROM label_changes", "SELECT * FROM multipliers"})
                attempt([&] {
                    auto rows = file.query(sql);
                    for (int i = 0; i < 100'000 && rows.next(); ++i)
                        rows.text(0);
                });
        });
        return message;
    }

    testing::TemporaryFolder folder;
    std::string path = folder / "results.sqlite", image;
};

TEST_F(HostileFile, QueriesOnlyRead) {
    for (const auto access : {ResultFile::Access::read, ResultFile::Access::write}) {
        const ResultFile file(path, access);
        for (const std::string sql : {"DELETE FROM points_r",
                                      "DELETE FROM points_r RETURNING *",
                                      "UPDATE runs SET name = 'x'",
                                      "DROP TABLE runs",
                                      "INSERT INTO runs(name) VALUES('x')",
                                      "CREATE TABLE t(x)",
                                      "CREATE TEMP TABLE t(x)",
                                      "ATTACH '/tmp/x' AS x",
                                      "PRAGMA query_only = 0",
                                      "PRAGMA user_version",
                                      "PRAGMA writable_schema = 1",
                                      "VACUUM",
                                      "VACUUM INTO '/tmp/x'",
                                      "BEGIN",
                                      "COMMIT",
                                      "REINDEX",
                                      "ANALYZE",
                                      "SELECT load_extension('x')",
                                      "SELECT 1; DELETE FROM points_r",
                                      "SELECT 1; SELECT 2",
                                      "SELECT 1;;; /* */ SELECT 2",
                                      "",
                                      ";",
                                      "-- nothing",
                                      "SELECT",
                                      "nonsense",
                                      "WITH x AS (SELECT 1) DELETE FROM points_r",
                                      "SELECT * FROM pragma_database_list",
                                      "EXPLAIN DELETE FROM points_r",
                                      "REPLACE INTO runs(name) VALUES('x')",
                                      "SAVEPOINT x",
                                      "DETACH main",
                                      "SELECT writefile('/tmp/x', 'x')",
                                      "SELECT zeroblob(1000000000)",
                                      "SELECT * FROM fts3tokenize"})
            EXPECT_THROW(file.query(sql).next(), InputError) << sql;
        EXPECT_THROW(file.query(std::string("SELECT 1\0; DELETE FROM points_r", 31)), InputError);
        for (const std::string sql :
             {"SELECT 1", "SELECT 1;", " SELECT 1 ; -- that is all", "SELECT 1;; /* all */ ;\n",
              "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 9) SELECT * FROM n"})
            EXPECT_TRUE(file.query(sql).next()) << sql;
        EXPECT_EQ(file.point_count("r"), 20u);
    }
}

TEST_F(HostileFile, QueriesEndWhenTheirThreadIsAskedTo) {
    const std::string endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT max(i) FROM n";
    ResultFile file(path, ResultFile::Access::read);
    const auto begun = std::chrono::steady_clock::now();
    {
        int asked = 0;
        const QueryInterruption outer([&] { return ++asked > 3; });
        {
            const QueryInterruption inner([] { return false; });
            EXPECT_FALSE(QueryInterruption::requested());
        }
        try {
            file.query(endless).next();
            ADD_FAILURE() << "it ends by itself";
        } catch (const InputError& error) {
            EXPECT_EQ(error.problem(), "the query was interrupted");
        }
        EXPECT_GT(asked, 3);
    }
    EXPECT_FALSE(QueryInterruption::requested());
    EXPECT_EQ(file.point_count("r"), 20u);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, 20s);
}

TEST_F(HostileFile, PathsWithAZeroByteAreRefused) {
    const std::string cut = path + std::string("\0ignored", 8);
    EXPECT_THROW(ResultFile(cut, ResultFile::Access::read), InputError);
    EXPECT_THROW(ResultFile(cut, ResultFile::Access::write), InputError);
    ResultFile file(path, ResultFile::Access::write);
    EXPECT_THROW(file.copy_to(path + std::string(".copy\0ignored", 13)), InputError);
    EXPECT_FALSE(std::filesystem::exists(path + ".copy"));
}

TEST_F(HostileFile, EndlessQueriesAreInterrupted) {
    ResultFile file(path, ResultFile::Access::read);
    file.set_patience(100ms);
    for (const std::string sql :
         {"WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT max(i) FROM n",
          "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i FROM n",
          "SELECT count(*) FROM samples_r a, samples_r b, samples_r c, samples_r d, samples_r e, samples_r f",
          "SELECT * FROM samples_r a, samples_r b, samples_r c, samples_r d, samples_r e ORDER BY random()"}) {
        const auto begun = std::chrono::steady_clock::now();
        EXPECT_THROW(
            {
                auto rows = file.query(sql);
                while (rows.next())
                    rows.number(0);
            },
            InputError)
            << sql;
        EXPECT_LT(std::chrono::steady_clock::now() - begun, 20s) << sql; // also on a loaded machine
    }
    EXPECT_EQ(file.point_count("r"), 20u);
}

TEST_F(HostileFile, ContradictionsAreRefused) {
    const std::string endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT ";
    for (const std::string& sql : {
             std::string("UPDATE runs SET name = '../x'"),
             std::string("UPDATE runs SET name = 'a' || char(10) || 'system ''id'''"),
             std::string("UPDATE runs SET name = '-o'"),
             std::string("UPDATE runs SET name = NULL"),
             std::string("UPDATE runs SET name = printf('%.*c', 200, 'x')"),
             std::string("UPDATE runs SET kind = 'strange'"),
             std::string("UPDATE runs SET kind = 'sweep'; DELETE FROM columns"),
             std::string("UPDATE runs SET model = ''"),
             std::string("UPDATE runs SET model = replace(model, 'v', 'w')"),
             std::string("UPDATE runs SET model_name = char(27) || '[2J'"),
             std::string("UPDATE columns SET unit = char(10) || 'x'"),
             std::string("UPDATE columns SET name = 'a`b' || char(0) || 'c'"),
             std::string("DELETE FROM columns WHERE place = 'state'"),
             std::string("DELETE FROM names WHERE what = 'sampling'"),
             std::string("DELETE FROM names WHERE what = 'mode'"),
             std::string("UPDATE samples_r SET sampling = 'other'"),
             std::string("ALTER TABLE points_r DROP COLUMN detail"),
             std::string("DROP TABLE samples_r"),
             std::string("DROP TABLE columns"),
             std::string("UPDATE runs SET kind = 'continue'"),
             std::string("PRAGMA user_version = 99; DELETE FROM meta"),
             std::string("PRAGMA application_id = 99"),
             "DROP VIEW all_points; CREATE VIEW all_points AS " + endless + "max(i) FROM n",
             "DROP TABLE points_r; CREATE VIEW points_r AS " + endless + "i FROM n",
             "DROP TABLE runs; CREATE VIEW runs AS " + endless + "i AS number, 'r' AS name FROM n",
             std::string("DROP TABLE multipliers; CREATE VIEW multipliers AS SELECT zeroblob(900000000)"),
         }) {
        tamper(sql);
        EXPECT_NE(refusal(), "") << sql;
    }
    restore(image);
    EXPECT_EQ(refusal(), "");
}

TEST_F(HostileFile, TriggersAreDisabled) {
    tamper("CREATE TRIGGER t AFTER INSERT ON points_r BEGIN DELETE FROM runs; DELETE FROM samples_r; END");
    {
        ResultFile file(path, ResultFile::Access::write);
        file.add_point("r", point_numbered(20));
    }
    const ResultFile file(path, ResultFile::Access::read);
    EXPECT_EQ(file.point_count("r"), 21u);
    EXPECT_EQ(file.point("r", 20)->result.samples.size(), 5u);
}

TEST_F(HostileFile, DamagedBytesAreReadOrRefused) {
    std::mt19937 random(1);
    const auto number = [&](std::size_t below) {
        return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
    };
    int refused = 0;
    for (int i = 0; i < 250; ++i) {
        std::string bytes = image;
        // About half of the changes are in headers of pages. The first 16 bytes, by which SQLite recognises its files,
        // are left unchanged.
        for (std::size_t change = 0; change < 1 + number(8); ++change) {
            const std::size_t page = number(bytes.size() / 8192) * 8192;
            const std::size_t at = page + (number(2) == 0 ? number(128) : number(8192));
            bytes[at < 16 ? at + 100 : at] = static_cast<char>(number(256));
        }
        if (number(5) == 0)
            bytes.resize(number(bytes.size()));
        restore(bytes);
        refused += refusal().empty() ? 0 : 1;
    }
    EXPECT_GT(refused, 50);
}

TEST_F(HostileFile, OnlyPlainFilesAreOpened) {
    const std::string pipe = folder / "pipe", link = folder / "link";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::filesystem::create_symlink(path, link);
    for (const std::string& name : {pipe, std::string("/dev/zero"), folder.path()})
        EXPECT_THROW(ResultFile(name, ResultFile::Access::read), InputError) << name;
    EXPECT_NO_THROW(ResultFile(link, ResultFile::Access::read));
    EXPECT_THROW(ResultFile(link, ResultFile::Access::write), InputError);
    std::filesystem::create_symlink(folder / "elsewhere", folder / "new.sqlite.lock");
    EXPECT_THROW(ResultFile(folder / "new.sqlite", ResultFile::Access::write), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder / "elsewhere"));
}

TEST_F(HostileFile, RemovalWhileWritingIsDetected) {
    for (const bool replaced : {false, true}) {
        ResultFile file(path, ResultFile::Access::write);
        file.begin_run(run_named("r"));
        file.add_point("r", point_numbered(0));
        std::filesystem::remove(path);
        if (replaced)
            restore("something else");
        EXPECT_THROW(
            {
                file.add_point("r", point_numbered(1));
                file.flush();
            },
            InputError);
        std::filesystem::remove(path);
    }
}

} // namespace graze::hostile_file_test
