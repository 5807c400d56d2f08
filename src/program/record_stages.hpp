#pragma once

#include "graze/record/samples.hpp"
#include "program/arguments.hpp"

#include <memory>
#include <string>
#include <vector>

namespace graze {

/// A record with all that is done to it before a table is made.
class RecordStages {
public:
    /// @throws InputError for what is no record, and options without meaning
    RecordStages(const std::string& path, const RecordArguments& arguments);
    SampleSource& source() { return *stages_.back(); }
    const RecordHeader& header() const { return stages_.back()->header(); }
    /// Indices of the channels that are asked for, or of all.
    std::vector<std::size_t> channels(const std::vector<std::string>& asked) const;

private:
    std::vector<std::unique_ptr<SampleSource>> stages_; ///< each reads from the one before
};

} // namespace graze
