#pragma once

#include "graze/results/result_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// Writes runs as an HDF5 file: a group for each, with model, settings, fingerprint and version as attributes, and in
/// it groups `points`, `samples` and `multipliers` with a dataset for each column (64-bit floats, whole numbers or
/// texts), which tells its unit by the attribute `units`; of runs that have found parameters from measurements also
/// `estimates` and `covariances`, as in the result file, where each row has its unit. Numbers that are missing are NaN
/// there, whole numbers -1; texts are padded with zeros to the longest of their column, unless that is longer than
/// 65536 bytes.
/// @throws InputError when the file cannot be written, or a model in it cannot be read
void export_hdf5(const ResultFile& file, const std::vector<std::string>& runs, const std::string& path);

} // namespace graze
