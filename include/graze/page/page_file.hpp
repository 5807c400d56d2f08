#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// What a page of results contains.
struct PageFileOptions {
    std::string title{};                  ///< of the page; empty: the name of the study, or else "results"
    std::vector<std::string> runs{};      ///< only these; empty: all
    std::vector<StudyPicture> pictures{}; ///< besides those of the study; each needs a name of its own
    /// Bytes of data, about which the file has. All runs and pictures are in it, whatever their size; then special
    /// points, and after these other points, evenly chosen, as long as there is room.
    std::size_t most_bytes = std::size_t{20} << 20;
};

/// Returns one HTML file that shows results without a program or a network: diagrams, and orbits of the points that are
/// clicked, or of the nearest ones that it contains.
/// @throws InputError for unknown runs and pictures that cannot be made, and where graze was built without the page
std::string page_file(const ResultFile& file, const PageFileOptions& options = {});

} // namespace graze
