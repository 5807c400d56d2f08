#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// One property of something in a file, for example that the kind of the study's run "free" is "continue".
struct Fact {
    std::string item, name, property;
    std::optional<double> number; ///< none: the value is a text
    std::string text, unit;
};

/// A list of facts about a file.
class Facts {
public:
    void add(const std::string& item, const std::string& name, const std::string& property, const std::string& text);
    void add(const std::string& item, const std::string& name, const std::string& property, double number,
             const std::string& unit = "");
    const std::vector<Fact>& all() const { return all_; }
    /// The text of the first fact with this item, name and property; empty if there is none.
    std::string text(const std::string& item, const std::string& name, const std::string& property) const;
    /// The texts of all facts with this item, name and property.
    std::vector<std::string> texts(const std::string& item, const std::string& name, const std::string& property) const;
    std::optional<double> number(const std::string& item, const std::string& name, const std::string& property) const;
    /// Names of all items of this kind, in the order in which they were added.
    std::vector<std::string> names(const std::string& item) const;

private:
    const Fact* find(const std::string& item, const std::string& name, const std::string& property) const;
    std::vector<Fact> all_;
};

/// Adds the size of a file, and when it was written. @param path empty: the file comes with graze
void add_file_facts(Facts& facts, const std::string& path, const std::string& kind);
void add_facts(Facts& facts, const Model& model);
void add_facts(Facts& facts, const Study& study);
void add_facts(Facts& facts, const ResultFile& file);

} // namespace graze
