#pragma once

#include "graze/study/study.hpp"
#include "program/arguments.hpp"

namespace graze {

/// The name of the run that `graze atlas MODEL` makes.
inline constexpr const char* atlas_run_name = "atlas";

/// The study of one run of kind atlas that the options of `graze atlas MODEL` describe. Its text is one that the user
/// could have written.
/// @throws InputError with the option as its place
Study atlas_study(const AtlasArguments& arguments);

} // namespace graze
