#pragma once

#include "graze/model/named_value.hpp"
#include "graze/study/point_motion.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// Most values of a motion that are asked for at once: the page needs the states of a model, its quantities, and what
/// its drawing needs.
inline constexpr std::size_t most_motion_names = 500;

/// Most rows of a motion that the page gets; fewer if there are so many columns that the numbers would be too many.
std::size_t most_rows_of(std::size_t columns);

/// What a motion does not say of itself.
struct MotionShown {
    bool complete = true;           ///< these are all rows of it, but for thinning
    std::size_t most_rows = 20'000; ///< fewer of many columns
};

/// Leaves out rows of a motion so that about `most` remain, evenly, but for those at the beginning and end of arcs and
/// at contacts, which stay. Of so many arcs and contacts that their rows would be more, some are forgotten.
void thin_rows(DenseMotion& motion, std::size_t most);

/// A motion as the page draws it: columns with names, units, words and periods (of cyclic values; null for others),
/// values column by column, rows at which arcs begin, rows at contacts, the mode of each arc, and how it ended.
/// @param columns of the values of the motion, of which the first is the time
nlohmann::json motion_rows_json(const Model& model, const std::vector<NamedValue>& columns, DenseMotion motion,
                                const MotionShown& shown);

/// The values that are asked for, after the time. Without any: the states that pictures show.
/// @param run whose study may have named values of its own; null: none
/// @throws InputError for texts that are neither names nor expressions, and for too many or too long ones
std::vector<NamedValue> motion_columns(const Model& model, const std::vector<std::string>& names,
                                       const StoredRun* run = nullptr);

} // namespace graze
