#pragma once

#include "model/model_file_toml.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace graze {

class StudyReader;
struct StudyRun;

/// A key of a run. Functions that describe the keys of a run (run_description.hpp) say each of them once, to whatever
/// needs to know: what reads studies, what stores settings and reads them again, what lists keys for pages and editors.
struct Key {
    const char* name;
    const char* meaning; ///< one phrase, with the unit if there is one
    /// Whether runs of this kind offer it. What they do not may be stored with their settings all the same.
    bool offered = true;
    const char* standard = nullptr; ///< what holds without it, in words; null: the value that it has then
    std::string idle = {}; ///< why it has no effect in this run, such as "has no effect on a fit"; empty: it has one
};

/// Whole numbers that a key takes.
struct CountRange {
    std::size_t least = 0, most = 1'000'000'000;
};
/// As far as TOML's numbers go.
inline constexpr CountRange any_seed{0, static_cast<std::size_t>(std::numeric_limits<std::int64_t>::max())};
/// Numbers that a key takes.
struct NumberRange {
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    bool includes_least = true;

    bool contains(double value) const { return (includes_least ? value >= least : value > least) && value <= most; }
};
inline constexpr NumberRange any_number{}, positive_number{0, std::numeric_limits<double>::infinity(), false};

/// Reads what has a form of its own: a table, or one of several.
using FormReader = void (*)(const StudyReader&, StudyRun&, const TomlEntry&);
/// Of keys that are read before or after all others.
inline constexpr FormReader read_apart = nullptr;

/// Part of what is only after keys: what is stored and has no key is passed over.
class KeysAlone {
public:
    static constexpr bool stored = false, reading = true;

    template <class... Arguments>
    void field(Arguments&&...) const {}
    template <class... Arguments>
    void optional(Arguments&&...) const {}
    template <class... Arguments>
    void follows(Arguments&&...) const {}
    template <class... Arguments>
    void words(Arguments&&...) const {}
    template <class... Arguments>
    void named(Arguments&&...) const {}
    template <class... Arguments>
    void expressions(Arguments&&...) const {}
    template <class... Arguments>
    void list(Arguments&&...) const {}
    bool has(std::string_view, bool) const { return true; }
};

} // namespace graze
