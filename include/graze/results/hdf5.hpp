#pragma once

#include "graze/results/result_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// Writes runs as an HDF5 file. Each run is a group, with model, settings, fingerprint and version as attributes, and
/// with the groups `points`, `samples` and `multipliers`. These have a dataset for each column (64-bit floats, whole
/// numbers or texts), whose attribute `units` is its unit. Runs of kind `identify` also have the groups `estimates` and
/// `covariances`, in which each row has its own unit, as in the result file. Missing numbers are NaN, missing whole
/// numbers -1. Texts are padded with zero bytes to the longest of their column, or have variable length if one of the
/// column is longer than 65536 bytes.
/// @throws InputError when the file cannot be written, or a model in it cannot be read
void export_hdf5(const ResultFile& file, const std::vector<std::string>& runs, const std::string& path);

} // namespace graze
