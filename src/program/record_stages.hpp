#pragma once

#include "graze/record/processed_record.hpp"
#include "program/arguments.hpp"
#include "program/commands.hpp"

#include <string>
#include <vector>

namespace graze {

/// Passes samples on. Where there are none at all, whatever is made of them would be an empty answer.
class RequiredRows : public SampleSource {
public:
    explicit RequiredRows(SampleSource& source) : source_(&source) {}
    const RecordHeader& header() const override { return source_->header(); }
    /// @throws InputError at the end of a source that has given none
    bool read(Samples& samples) override;

private:
    SampleSource* source_;
    bool has_rows_ = false;
};

/// A record with all that is done to it before a table is made.
class RecordStages {
public:
    /// @throws InputError for what is no record, and options without meaning
    RecordStages(const std::string& path, const RecordArguments& arguments, const Console& console);
    SampleSource& source() { return rows_; }
    const RecordHeader& header() const { return record_.header(); }
    /// Indices of the channels that are asked for, or of all.
    std::vector<std::size_t> channels(const std::vector<std::string>& asked) const;

private:
    RecordStages(const std::string& path, const RecordProcessing& processing);
    ProcessedRecord record_;
    RequiredRows rows_;
};

} // namespace graze
