#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Something that is known of what is in a file: of the study's run "free", say, that its kind is "continue".
struct Fact {
    std::string item, name, property;
    std::optional<double> number; ///< none: it is a text
    std::string text, unit;
};

/// What is known of a file, fact by fact.
class Facts {
public:
    void add(const std::string& item, const std::string& name, const std::string& property, const std::string& text);
    void add(const std::string& item, const std::string& name, const std::string& property, double number,
             const std::string& unit = "");
    const std::vector<Fact>& all() const { return all_; }
    /// The text of the first such fact; empty if there is none.
    std::string text(const std::string& item, const std::string& name, const std::string& property) const;
    /// The texts of all such facts.
    std::vector<std::string> texts(const std::string& item, const std::string& name, const std::string& property) const;
    std::optional<double> number(const std::string& item, const std::string& name, const std::string& property) const;
    /// Names of all items of one kind, in their order.
    std::vector<std::string> names(const std::string& item) const;

private:
    const Fact* find(const std::string& item, const std::string& name, const std::string& property) const;
    std::vector<Fact> all_;
};

/// Its size, and when it was written. @param path empty: it comes with graze
void add_file_facts(Facts& facts, const std::string& path, const std::string& kind);
void add_facts(Facts& facts, const Model& model);
void add_facts(Facts& facts, const Study& study);
void add_facts(Facts& facts, const ResultFile& file);

} // namespace graze
