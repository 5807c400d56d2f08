#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/base/input_errors.hpp"
#include "model/model_file_toml.hpp"

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

namespace graze {

/// Reads an experiment from TOML; after an error in one table the others are still read.
class ExperimentReader {
public:
    explicit ExperimentReader(const std::string& file) : toml_(file) { experiment_.file = file; }
    Experiment read(const toml::table& root);

private:
    using Keys = std::map<std::string, TomlEntry>;
    void read_generator(const TomlEntry& entry);
    void read_limits(const TomlEntry& entry);
    void read_samples(const TomlEntry& entry);
    void read_sweep(const TomlEntry& entry);
    void read_settle(const TomlEntry& entry);
    void read_record(const TomlEntry& entry);
    void read_resume(const TomlEntry& entry);
    void check() const;

    Keys keys_of(const TomlEntry& entry, std::initializer_list<std::string_view> known) const;
    double number(const TomlEntry& entry, double least, double most) const;
    std::size_t count(const TomlEntry& entry, std::size_t least, std::size_t most) const;
    std::size_t choice(const TomlEntry& entry, std::initializer_list<std::string_view> words) const;
    std::vector<std::string> names(const TomlEntry& entry) const;
    /// A value of a sweep, with the direction from which it is reached.
    struct Stepped {
        double value = 0;
        int direction = 0;
    };
    std::vector<Stepped> values(const TomlEntry& entry, double least, double most) const;
    [[noreturn]] void fail(const TomlEntry& entry, const std::string& problem, const std::string& remedy) const;

    TomlReader toml_;
    Experiment experiment_;
    Mistakes mistakes_;
    Keys tables_;
    bool has_limits_ = false; ///< and they could be read
};

} // namespace graze
