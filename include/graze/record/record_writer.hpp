#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace graze {

/// Writes a record in parts, in a format that open_record reads: HDF5 if the file's name ends in .h5 or .hdf5,
/// otherwise text with commas and numbers that are read back exactly.
class RecordWriter {
public:
    /// @throws InputError when the file cannot be written
    RecordWriter(const std::string& path, const RecordHeader& header);
    ~RecordWriter();
    RecordWriter(const RecordWriter&) = delete;
    RecordWriter& operator=(const RecordWriter&) = delete;
    /// @throws InputError when the file cannot be written or is closed, for numbers that are not finite, and when the
    /// number of channels differs from the header's
    void write(const Samples& samples);
    /// Completes the file. @throws InputError when it cannot be written, or is closed already
    void close();

    class Target;

private:
    std::unique_ptr<Target> target_; ///< null once it is closed
    std::size_t channels_ = 0;
};

/// Writes channels of a record to a file. @param channels their indices
/// @param interrupted asked after each part that is read
/// @return false when it was interrupted: the file then has a part of the record
/// @throws InputError as RecordWriter and the source do
bool write_record(SampleSource& source, const std::vector<std::size_t>& channels, const std::string& path,
                  const std::function<bool()>& interrupted = {});

} // namespace graze
