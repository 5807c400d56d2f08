#pragma once

#include "graze/design/design.hpp"
#include "study/study_reader.hpp"

namespace graze {

/// Reads the requirements of a design, whose model, dimensions and yield are known.
class WantedReader {
public:
    WantedReader(const StudyReader& reader, Design& design)
        : reader_(reader), design_(design), wanted_(design.wanted) {}

    void read(const TomlEntry& entry);

private:
    void read_item(const TomlEntry& item);
    void read_value(const TomlEntry& item);
    void read_yield(const TomlEntry& item);
    void read_importance(const TomlEntry& item);
    double number(const TomlEntry& entry) const { return reader_.number(design_.model, entry); }

    const StudyReader& reader_;
    Design& design_;
    Wanted& wanted_;
};

} // namespace graze
