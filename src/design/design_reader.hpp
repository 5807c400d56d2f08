#pragma once

#include "graze/design/design.hpp"
#include "study/study_reader.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>

namespace graze {

/// Reads a design from TOML; after an error in one part the others are still read.
class DesignReader {
public:
    explicit DesignReader(const std::string& file) : reader_(file) { design_.file = file; }

    Design read(const toml::table& root);

private:
    void read_keys(const toml::table& root);
    void read_approach(const TomlEntry& entry);
    void read_model();
    void take_model_of_study();
    void read_set(const TomlEntry& entry);
    void read_control();
    void read_branch();
    void read_trip(const TomlEntry& entry);
    void read_dimension(const TomlEntry& entry);
    void read_dimensions();
    DesignTolerance tolerance_of(const TomlEntry& entry) const;
    std::optional<std::size_t> dimension_named(const TomlEntry& entry) const;
    void read_choices();
    void read_yield(const TomlEntry& entry);
    const TomlEntry* key(const std::string& name) const;
    double number(const TomlEntry& entry) const { return reader_.number(design_.model, entry); }
    ParameterId parameter_of(const TomlEntry& entry, const std::string& name) const;

    StudyReader reader_;
    Design design_;
    Mistakes mistakes_;
    std::map<std::string, TomlEntry> keys_;
    std::map<std::string, TomlEntry> approach_;
    std::set<std::string> dimension_names_; ///< also of invalid ones
    bool whole_ = true;                     ///< whether all top-level keys could be read
};

/// Reads the requirements of a design, whose model, dimensions and yield are known.
class WantedReader {
public:
    WantedReader(const StudyReader& reader, Design& design)
        : reader_(reader), design_(design), wanted_(design.wanted) {}

    void read(const TomlEntry& entry);

private:
    void read_value(const TomlEntry& item);
    void read_trip_time(const TomlEntry& item);
    void read_sensitivity(const TomlEntry& item);
    void read_yield(const TomlEntry& item);
    void read_importance(const TomlEntry& item);
    double number(const TomlEntry& entry) const { return reader_.number(design_.model, entry); }

    const StudyReader& reader_;
    Design& design_;
    Wanted& wanted_;
};

} // namespace graze
