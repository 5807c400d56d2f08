#pragma once

#include "graze/page/page_file.hpp"

#include <string>

namespace graze {

/// The data of a page of results, as the script of the page reads them: {session, runs, pictures, figures,
/// special_points, points, motions, models}. The text can stand within a script of a page.
std::string stored_page(const ResultFile& file, const PageFileOptions& options);

/// The page with data in it. @param html of the page @param data as stored_page gives them
std::string page_with(std::string_view html, const std::string& data);

} // namespace graze
