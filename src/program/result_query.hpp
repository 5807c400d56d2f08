#pragma once

#include "graze/model/model.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "program/curve.hpp"

#include <map>
#include <string>
#include <vector>

namespace graze {

/// A text between SQL's quotes.
std::string in_quotes(const std::string& text);
/// A column's name between SQL's quotes.
std::string quoted_column(const std::string& name);
/// The result file of a folder, or the file itself.
std::string result_path(const std::string& file_or_folder);

/// A run with its model, as stored.
struct StoredRun {
    StoredRun(const ResultFile& file, const std::string& name, const Place& place);

    RunRecord record;
    Model model;
    std::string points, samples; ///< quoted names of its tables; of a branch its orbits and their segments
    std::string joined;          ///< both, as p and s
    std::vector<std::string> coordinate_columns, state_columns, value_columns; ///< of those of the record; unquoted

    /// Column of a coordinate (of p) or value (of s, of a branch of p); `multiplier` of a branch is the greatest one's
    /// modulus; other texts are expressions in columns and stay as they are.
    std::string column(const std::string& name) const;
    /// Column of a value, even if a coordinate has the same name.
    std::string value_column(const std::string& name) const;
    std::string unit(const std::string& name) const;
    bool has_value(const std::string& name) const;
};

/// The point whose coordinates are nearest to those asked for; the last one if none are.
/// @throws InputError when there is none
PointRecord chosen_point(const ResultFile& file, const StoredRun& run, const StudyPicture& picture);

/// A motion recomputed densely. @param names of values or expressions; "t" is the time
/// @return for each name its values; where a jump happened, before and after
std::vector<std::vector<double>> dense_motion(const StoredRun& run, const PointRecord& point,
                                              const std::vector<std::string>& names, const Place& place);

} // namespace graze
