#pragma once

#include "graze/study/study_keys.hpp"
#include "study/run_key.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Lists the keys of a run with their defaults.
class KeyList : public KeysOnly {
public:
    std::vector<StudyKey> keys;

    template <class Count>
    void count(const Key& key, Count& value, CountRange range = {}) {
        StudyKey* one = add(key, "whole number");
        if (!one)
            return;
        one->least = static_cast<double>(range.least);
        one->most = static_cast<double>(range.most);
        if (static_cast<std::size_t>(value) >= range.least)
            say(key, *one, fmt::format("{}", value));
    }
    void number(const Key& key, double& value, const NumberRange& range) {
        StudyKey* one = add(key, "number");
        if (!one)
            return;
        if (std::isfinite(range.least))
            one->least = range.least, one->includes_least = range.includes_least;
        if (std::isfinite(range.most))
            one->most = range.most;
        if (value > range.least || (range.includes_least && value == range.least))
            say(key, *one, without_zeros(fmt::format("{:g}", value)));
    }
    void truth(const Key& key, bool& value) {
        if (StudyKey* one = add(key, "true or false"))
            one->standard = value ? "true" : "false";
    }
    void denied(const Key& key, const char*, bool& value) {
        if (StudyKey* one = add(key, "true or false"))
            one->standard = value ? "false" : "true";
    }
    template <class Choice>
    void choice(const Key& key, Choice& value, const std::vector<std::string>& words) {
        if (StudyKey* one = add(key, "one of")) {
            one->words = words;
            one->standard = words[static_cast<std::size_t>(value)];
        }
    }
    void line(const Key& key, std::string& value) {
        if (StudyKey* one = add(key, "text"))
            one->standard = value;
    }
    void later_number(const Key& key, std::string&) { add(key, "number"); }
    void form(const Key& key, const char* written, FormReader) { add(key, written); }

    template <class Describe>
    void table(const Key& key, const char* written, const Describe&) {
        add(key, written);
    }

    template <class Describe>
    void object(std::string_view, Describe describe) {
        describe(*this);
    }

private:
    static void say(const Key& key, StudyKey& one, std::string standard) {
        one.standard = key.standard ? key.standard : std::move(standard);
    }
    /// "1e-6" of "1e-06"
    static std::string without_zeros(std::string number) {
        if (const std::size_t at = number.find("e-0"); at != std::string::npos)
            number.erase(at + 2, 1);
        return number;
    }
    StudyKey* add(const Key& key, std::string type) {
        if (!key.offered)
            return nullptr;
        keys.push_back({key.name, std::move(type), "", key.meaning, {}, {}, true, {}});
        return &keys.back();
    }
};

} // namespace graze
