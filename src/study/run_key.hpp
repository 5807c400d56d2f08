#pragma once

#include "model/model_file_toml.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace graze {

class StudyReader;
struct StudyRun;

/// A key of a run. The functions of run_description.hpp describe each key once, to any of four visitors: KeyReader
/// reads studies, SettingsWriter and SettingsReader store settings and read them, KeyList lists keys for pages and
/// editors.
struct Key {
    const char* name;
    const char* meaning; ///< one phrase, with the unit if there is one
    /// Users may give the key in runs of this kind. A key that is not offered may be stored all the same.
    bool offered = true;
    const char* standard = nullptr; ///< its default in words; null: the value that it has in a new run
    std::string idle = {}; ///< why it has no effect in this run, such as "has no effect on a fit"; empty: it has one
    const char* stored_as = nullptr; ///< the name of the field that is stored, where it is not that of the key
};

/// A key within a table whose meaning describes all its keys.
/// @param stored the name of the field that is stored; null: that of the key
inline Key key_in_table(const char* name, const char* stored = nullptr) {
    return {name, "", true, nullptr, {}, stored};
}

/// The range of a whole number.
struct CountRange {
    std::size_t least = 0, most = 1'000'000'000;
};
/// The largest range of integers that TOML has.
inline constexpr CountRange any_seed{0, static_cast<std::size_t>(std::numeric_limits<std::int64_t>::max())};
/// The range of a number.
struct NumberRange {
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    bool includes_least = true;

    bool contains(double value) const { return (includes_least ? value >= least : value > least) && value <= most; }
};
inline constexpr NumberRange any_number{}, positive_number{0, std::numeric_limits<double>::infinity(), false};

/// Reads a key that has a form of its own, such as a table.
using FormReader = void (*)(const StudyReader&, StudyRun&, const TomlEntry&);
/// Stands for the reader of a key that is read before or after all others.
inline constexpr FormReader read_apart = nullptr;

/// Fields without keys: in turn the name of one and its value.
template <class Fields, class Value, class... Others>
void describe_fields(Fields& fields, const char* name, Value& value, Others&... others) {
    fields.field(name, value);
    if constexpr (sizeof...(others) > 0)
        describe_fields(fields, others...);
}
/// A field without a key that is stored only where it differs from zero, false or nothing.
template <class Fields, class Value>
void describe_if_given(Fields& fields, const char* name, Value& value) {
    if (fields.has(name, value != std::remove_const_t<Value>()))
        fields.field(name, value);
}

/// Base of visitors that see keys only: they ignore fields that are stored without a key.
class KeysOnly {
public:
    static constexpr bool stored = false, reading = true;

    template <class... Arguments>
    void field(Arguments&&...) const {}
    template <class... Arguments>
    void optional(Arguments&&...) const {}
    template <class... Arguments>
    void follows(Arguments&&...) const {}
    template <class... Arguments>
    void named(Arguments&&...) const {}
    template <class... Arguments>
    void expressions(Arguments&&...) const {}
    template <class... Arguments>
    void list(Arguments&&...) const {}
    bool has(std::string_view, bool) const { return true; }
};

} // namespace graze
