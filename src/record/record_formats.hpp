#pragma once

#include "graze/record/record_file.hpp"

#include <memory>
#include <string>

namespace graze {

/// Whether a file begins with the signature of HDF5.
bool is_hdf5(const std::string& path);

/// Opens a record in a text file.
std::unique_ptr<SampleSource> open_text_record(const std::string& path, const RecordLayout& layout);
/// Opens a record whose channels are datasets in a group of an HDF5 file.
std::unique_ptr<SampleSource> open_hdf5_record(const std::string& path, const RecordLayout& layout);

} // namespace graze
