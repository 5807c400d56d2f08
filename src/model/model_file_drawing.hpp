#pragma once

#include "model/model_file_tables.hpp"

#include <string>

namespace graze {

/// Reads the table [drawing] of a model.
class DrawingParts : protected TableParts {
protected:
    using TableParts::TableParts;

    void read_drawing(const TomlEntry& group);

private:
    DrawnShape shape(const TomlEntry& entry);
    DrawnPair pair(const TomlEntry& entry, const char* expected);
    std::vector<DrawnPair> path_points(const TomlEntry& entry);
    std::string required_text(const TomlEntry& entry);
};

} // namespace graze
