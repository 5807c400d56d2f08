#pragma once

#include "graze/results/stored_run.hpp"
#include "results/schema.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// The pieces of which queries of one run's tables are made: its points (orbits) as p, its samples (segments) as s.
class RunQuery {
public:
    explicit RunQuery(const RunRecord& run) : run_(&run), tables_(run) {}

    /// A column that every run has; of samples, where both have it and rows are samples.
    std::string column(const std::string& name, bool with_samples) const;
    /// What a user names: a coordinate or a value, a column, or an expression, which stays as it is.
    std::string quantity(const std::string& name) const;
    /// A value, even if a coordinate has the same name.
    std::string value(const std::string& name) const;
    /// Points, or points with their samples. @param all also points without samples
    std::string tables(bool with_samples, bool all) const;
    /// What holds of rows of these directions and samplings; of all if there are none.
    std::string condition(const std::vector<std::string>& directions, const std::vector<std::string>& samplings) const;
    /// The column that says in which direction a point was reached.
    std::string direction() const { return run_->is_branch() ? "p.part" : "p.direction"; }
    std::string order(bool with_samples) const;

    const RunTables& run_tables() const { return tables_; }

private:
    std::string column_of(const std::vector<ResultColumn>& things, ColumnGroup group, const std::string& name) const;

    const RunRecord* run_;
    RunTables tables_;
};

/// Number of the point of a run whose coordinates are nearest, as StoredRun::nearest.
std::optional<std::size_t> nearest_number(const ResultFile& file, const RunRecord& run,
                                          const std::vector<std::pair<std::string, double>>& at,
                                          const std::vector<std::string>& directions);

/// The unit of a column's numbers.
std::string unit_of(const RunColumn& column, const StoredRun& run);
std::string unit_of(ColumnUnit unit, const StoredRun& run);

} // namespace graze
