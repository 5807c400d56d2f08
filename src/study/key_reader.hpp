#pragma once

#include "study/key_list.hpp"
#include "study/run_key.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Reads the keys of a run from a study. Keys that the study does not have keep their values. After a mistake, which is
/// noted, the other keys are read.
class KeyReader : public KeysOnly {
public:
    KeyReader(const StudyReader& reader, StudyRun& run, const RunKeys& keys, Mistakes& mistakes)
        : reader_(reader), run_(run), keys_(keys), mistakes_(mistakes) {}

    template <class Count>
    void count(const Key& key, Count& value, CountRange range = {}) {
        read(key, [&](const TomlEntry& e) { value = static_cast<Count>(reader_.count(e, range.least, range.most)); });
    }
    void number(const Key& key, double& value, const NumberRange& range) {
        read(key, reader_.into(value, run_.model, range));
    }
    void truth(const Key& key, bool& value) { read(key, reader_.into(value)); }
    /// A key whose negation is stored.
    void denied(const Key& key, const char*, bool& value) {
        read(key, [&](const TomlEntry& e) { value = !reader_.toml().boolean(e); });
    }
    template <class Choice>
    void choice(const Key& key, Choice& value, const std::vector<std::string>& words) {
        read(key, [&](const TomlEntry& e) { value = static_cast<Choice>(reader_.choice(e, words)); });
    }
    void line(const Key& key, std::string& value) { read(key, reader_.into(value)); }
    /// A number, or an expression in parameters whose values other runs will find.
    void later_number(const Key& key, std::string& value) {
        read(key, [&](const TomlEntry& e) { value = reader_.number_text(run_.model, e); });
    }
    void form(const Key& key, const char*, FormReader read_form) {
        read(key, [&](const TomlEntry& e) {
            if (read_form)
                read_form(reader_, run_, e);
        });
    }

    /// A table of keys of its own. @param describe given what reads them
    template <class Describe>
    void table(const Key& key, const char*, const Describe& describe) {
        read(key, [&](const TomlEntry& e) { read_table(reader_, run_, e, describe); });
    }
    /// Reads a table of keys by itself.
    template <class Describe>
    static void read_table(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const Describe& describe) {
        KeyList known;
        describe(known);
        const std::vector<std::string> names = names_of(known.keys);
        RunKeys keys;
        Mistakes mistakes;
        mistakes.attempt([&] {
            reader.each_of(entry, {}, [&](const TomlEntry& item) {
                reader.toml().require_known(item, entry.path, names);
                keys.emplace(item.name, item);
            });
        });
        KeyReader fields(reader, run, keys, mistakes);
        describe(fields);
        mistakes.throw_noted();
    }

    /// True when the study has one of these keys and it could not be read.
    bool is_wrong(std::initializer_list<std::string_view> names) const {
        return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
            return std::find(wrong_.begin(), wrong_.end(), name) != wrong_.end();
        });
    }
    /// Keys that are stored in an object of their own stand beside the others in a study.
    template <class Describe>
    void object(std::string_view, Describe describe) {
        describe(*this);
    }

private:
    template <class Work>
    void read(const Key& key, const Work& work) {
        if (!key.offered)
            return;
        const bool good = with_key(mistakes_, keys_, key.name, [&](const TomlEntry& entry) {
            if (!key.idle.empty())
                reader_.fail(entry, fmt::format("`{}` {}", key.name, key.idle), "leave it out");
            work(entry);
        });
        if (!good)
            wrong_.emplace_back(key.name);
    }

    const StudyReader& reader_;
    StudyRun& run_;
    const RunKeys& keys_;
    Mistakes& mistakes_;
    std::vector<std::string> wrong_; ///< names of keys that could not be read
};

} // namespace graze
