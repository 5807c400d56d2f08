#pragma once

#include "graze/results/stored_run.hpp"
#include "results/schema.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Makes the parts of SQL queries on the tables of one run: points (orbits) as p, samples (segments) as s.
class RunQuery {
public:
    explicit RunQuery(const RunRecord& run) : run_(&run), tables_(run) {}

    /// A column that every run has; the one of samples if rows are samples and both tables have it.
    std::string column(const std::string& name, bool with_samples) const;
    /// A coordinate, value or column of this name; any other text is an SQL expression, which is put into brackets.
    /// @throws InputError if the text is no single expression
    std::string quantity(const std::string& name) const;
    /// A value, also if a coordinate has the same name.
    std::string value(const std::string& name) const;
    /// The table of points, or points joined with their samples. @param all whether points without samples are included
    std::string tables(bool with_samples, bool all) const;
    /// Condition for rows of these directions and samplings; an empty list stands for all.
    std::string condition(const std::vector<std::string>& directions, const std::vector<std::string>& samplings) const;
    /// The column with the direction or part of a point.
    std::string direction() const { return run_->is_branch() ? "p.part" : "p.direction"; }
    std::string order(bool with_samples) const;

    const RunTables& run_tables() const { return tables_; }

private:
    std::string column_of(const std::vector<ResultColumn>& columns, ColumnGroup group, const std::string& name) const;

    const RunRecord* run_;
    RunTables tables_;
};

/// Number of the point of a run whose coordinates are nearest, see StoredRun::nearest.
std::optional<std::size_t> nearest_number(const ResultFile& file, const RunRecord& run,
                                          const std::vector<std::pair<std::string, double>>& at,
                                          const std::vector<std::string>& directions);

/// The unit of the numbers in a column.
std::string unit_of(const RunColumn& column, const StoredRun& run);
std::string unit_of(ColumnUnit unit, const StoredRun& run);

} // namespace graze
