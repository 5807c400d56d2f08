#pragma once

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study_catalogue.hpp"
#include "shipped/shipped_results.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace graze::testing {

inline void expect_complete(const std::vector<RunReport>& reports) {
    for (const RunReport& report : reports)
        EXPECT_TRUE(report.complete()) << report.name << ": " << report.problem;
}

/// All that is in a file, to the last bit and in its order; but not when it was made.
inline std::string bits_of(const ResultFile& file) {
    std::string all;
    auto tables = file.query("SELECT name FROM sqlite_master WHERE type IN ('table', 'view') AND name <> 'meta' "
                             "ORDER BY name");
    while (tables.next()) {
        all += tables.text(0) + '\n';
        auto rows = file.query("SELECT * FROM \"" + tables.text(0) + '"');
        while (rows.next())
            for (std::size_t c = 0; c < rows.columns(); ++c)
                all += rows.is_text(c) || rows.is_null(c)
                           ? rows.text(c) + '|'
                           : std::to_string(std::bit_cast<std::uint64_t>(rows.number(c))) + '|';
    }
    return all;
}

inline std::vector<std::size_t> point_numbers_of(const ResultFile& file, const std::string& run) {
    std::vector<std::size_t> numbers;
    const auto next = file.point_numbers(run);
    while (const auto number = next())
        numbers.push_back(*number);
    return numbers;
}

/// A study in a folder of its own, with the results of the runs that are done.
class StudyResults {
public:
    explicit StudyResults(Study made)
        : study(std::move(made)), file_(folder_ / "results.sqlite", ResultFile::Access::write) {}
    /// A shipped study, with the results that there are of it.
    explicit StudyResults(const std::string& name)
        : study(load_study(name)), file_(begun(name), ResultFile::Access::write) {}

    /// With the runs that they start from.
    std::vector<RunReport> run(const std::vector<std::string>& names) {
        const std::vector<RunReport> reports = run_study(study, file_, {.only = names});
        expect_complete(reports);
        return reports;
    }
    const ResultFile& file() const { return file_; }
    const StudyTable& table(const std::string& name) const {
        for (const StudyTable& table : study.tables)
            if (table.name == name)
                return table;
        throw std::out_of_range(name);
    }

    const Study study;

private:
    std::string begun(const std::string& name) const {
        copy_shipped_results(name, folder_ / "results.sqlite");
        return folder_ / "results.sqlite";
    }

    TemporaryFolder folder_;
    ResultFile file_;
};

/// Carries out studies whose results are in a folder of the test's own.
class StudyFixture : public ::testing::Test {
protected:
    std::vector<RunReport> run(const std::string& text, const RunnerOptions& options = {}) const {
        const Study study = read_study(folder_.write("s.toml", text));
        ResultFile file(path_, ResultFile::Access::write);
        return run_study(study, file, options);
    }
    /// What refuses a study, or fails the first of its runs that does; empty: nothing.
    std::string refusal(const std::string& text) const {
        std::vector<RunReport> reports;
        std::string refused = message_of([&] { reports = run(text); });
        for (const RunReport& report : reports)
            if (!report.problem.empty())
                return report.problem + "; " + report.remedy;
        return refused;
    }

    TemporaryFolder folder_;
    const std::string path_ = folder_ / "results.sqlite";
};

} // namespace graze::testing
