#pragma once

#include "graze/model/named_value.hpp"
#include "graze/picture/figure.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/study.hpp"

#include <string>

namespace graze {

// What readers of a picture see in the place of names: what the study says, or else what the model says.

/// A text up to its first remark.
std::string first_words(const std::string& text);
/// The study's name for it, or its own with blanks in the place of underscores.
std::string shown_name(const StudyPicture& picture, const std::string& name);
/// NAME = VALUE with its unit.
std::string shown_value(const StudyPicture& picture, const StoredRun& run, const std::string& name, double value);
/// What the model, or what every run has, says of a value in a few words; empty if it says nothing.
std::string words_of(const StoredRun& run, const std::string& name);

/// Says what a panel's axes are, with words and units.
void label_axes(FigurePanel& panel, const StudyPicture& picture, const StoredRun& run, const std::string& x,
                const std::string& y);
void label_axis(std::string& label, std::string& words, std::string& unit, const StudyPicture& picture,
                const NamedValue& value);
/// What the study says of the axes, if anything, in the place of what they have. @param index of the panel's y
void apply_labels(FigurePanel& panel, const StudyPicture& picture, std::size_t index);

} // namespace graze
