#pragma once

#include "graze/model/named_value.hpp"
#include "graze/picture/figure.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/study.hpp"

#include <string>

namespace graze {

// Texts that pictures show instead of names: those of the study, otherwise those of the model.

/// A text up to the first of the characters ; , ( and :.
std::string first_words(const std::string& text);
/// The text that the picture gives for a name, or the name with blanks instead of underscores.
std::string shown_name(const StudyPicture& picture, const std::string& name);
/// The text "NAME = VALUE UNIT".
std::string shown_value(const StudyPicture& picture, const StoredRun& run, const std::string& name, double value);
/// A short description of a value, from the model or for values that every run has; empty if there is none.
std::string words_of(const StoredRun& run, const std::string& name);

/// Sets labels, descriptions and units of a panel's axes.
void label_axes(FigurePanel& panel, const StudyPicture& picture, const StoredRun& run, const std::string& x,
                const std::string& y);
void label_axis(std::string& label, std::string& words, std::string& unit, const StudyPicture& picture,
                const NamedValue& value);
/// Replaces axis labels by those that the picture gives. @param index index of the panel's y among the picture's values
void apply_labels(FigurePanel& panel, const StudyPicture& picture, std::size_t index);

} // namespace graze
