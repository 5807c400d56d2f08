#pragma once

#include "graze/record/processed_record.hpp"
#include "program/arguments.hpp"
#include "program/commands.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A record with all that is done to it before a table is made.
class RecordStages {
public:
    /// @throws InputError for what is no record, and options without meaning
    RecordStages(const std::string& path, const RecordArguments& arguments, const Console& console);
    SampleSource& source() { return record_->source(); }
    const RecordHeader& header() const { return record_->header(); }
    /// Indices of the channels that are asked for, or of all.
    std::vector<std::size_t> channels(const std::vector<std::string>& asked) const;

private:
    std::optional<ProcessedRecord> record_;
};

} // namespace graze
