#pragma once

#include "graze/symbolic/piece_table.hpp"
#include "model/model_file_parts.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Reads the table [tables] of a model: functions that are given by points.
class TableParts : protected ModelParts {
protected:
    using ModelParts::ModelParts;

    /// Allows tables in files. @param folder of the model file
    void allow_files(std::string folder) { folder_ = std::move(folder); }
    /// To be called before expressions are read, which may look tables up.
    void read_tables(const TomlEntry& group);

private:
    void read_table(const TomlEntry& entry);
    std::vector<PieceTable::Point> points_in(const TomlEntry& entry);
    std::vector<PieceTable::Point> points_of_file(const TomlEntry& entry, const std::vector<std::string>& columns);

    std::optional<std::string> folder_;
};

} // namespace graze
