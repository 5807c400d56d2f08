#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace graze {

/// Writes a record part by part, as open_record reads it: as HDF5 where the name of the file ends in .h5 or .hdf5, and
/// otherwise as text with commas and numbers that lose nothing.
class RecordWriter {
public:
    /// @throws InputError when the file cannot be written
    RecordWriter(const std::string& path, const RecordHeader& header);
    ~RecordWriter();
    RecordWriter(const RecordWriter&) = delete;
    RecordWriter& operator=(const RecordWriter&) = delete;
    /// @throws InputError when it cannot be written, is closed, or for samples that are no finite numbers or not as
    /// many
    ///         as the channels
    void write(const Samples& samples);
    /// Before this the file is not complete. @throws InputError when it cannot be written, or is closed already
    void close();

    class Target;

private:
    std::unique_ptr<Target> target_; ///< none once it is closed
    std::size_t channels_ = 0;
};

/// Writes channels of a record to a file. @param channels their indices
/// @param interrupted asked after each part that is read
/// @return false when it was interrupted: the file then has a part of the record
/// @throws InputError as RecordWriter and the source do
bool write_record(SampleSource& source, const std::vector<std::size_t>& channels, const std::string& path,
                  const std::function<bool()>& interrupted = {});

} // namespace graze
