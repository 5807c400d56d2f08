#pragma once

#include "base/json_text.hpp"
#include "graze/base/require.hpp"
#include "graze/model/named_value.hpp"
#include "graze/symbolic/transform.hpp"
#include "study/json.hpp"
#include "study/run_key.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace graze {

// Settings are described once, as the fields of an object, by functions of a visitor. SettingsWriter writes the fields
// as JSON, SettingsReader reads them.

/// @throws InputError for an index out of range, which a study that was made in C++ may have
inline const std::string& word_of(const std::vector<std::string>& words, std::size_t index) {
    require_index(index, words.size(), "setting");
    return words[index];
}

/// The index that an enumerator, a parameter or an index itself is.
template <class Item>
std::size_t index_of(const Item& item) {
    if constexpr (std::is_same_v<Item, ParameterId>)
        return item.place();
    else
        return static_cast<std::size_t>(item);
}

/// Base of visitors that store the keys of a run as fields, by name and value.
template <class Fields>
class StoredKeys {
public:
    static constexpr bool stored = true;

    template <class Count>
    void count(const Key& key, Count& value, CountRange range = {}) {
        within(key, value, [range](const auto& one) {
            return one >= static_cast<Count>(range.least) && one <= static_cast<Count>(range.most);
        });
    }
    template <class Number>
    void number(const Key& key, Number& value, const NumberRange& range) {
        within(key, value, [&range](double one) { return range.contains(one); });
    }
    template <class Truth>
    void truth(const Key& key, Truth& value) {
        fields().field(key.name, value);
    }
    /// A key whose negation is the field of this name.
    template <class Truth>
    void denied(const Key&, const char* name, Truth& value) {
        fields().field(name, value);
    }
    template <class Choice>
    void choice(const Key& key, Choice& value, const std::vector<std::string>& words) {
        fields().number(key.name, value, words.size());
    }
    template <class Text>
    void line(const Key& key, Text& value) {
        fields().field(key.name, value);
    }
    template <class Text>
    void later_number(const Key& key, Text& value) {
        fields().field(key.name, value);
    }
    void form(const Key&, const char*, FormReader) const {}
    /// Keys of a table are stored one by one, beside the others of the run.
    template <class Describe>
    void table(const Key&, const char*, const Describe& describe) {
        describe(fields());
    }

private:
    Fields& fields() { return static_cast<Fields&>(*this); }
    static const char* name_of(const Key& key) { return key.stored_as ? key.stored_as : key.name; }
    /// Refuses values out of range; a default may be out of range, as 0 may mean none.
    template <class Value, class Contains>
    void within(const Key& key, Value& value, const Contains& contains) {
        const auto standard = value;
        fields().field(name_of(key), value);
        if constexpr (Fields::reading)
            if (value != standard && !contains(value))
                fields().fail(name_of(key), "in the range that a study may give");
    }
};

/// Writes the members of a JSON object, in the order in which they are named.
class SettingsWriter : public StoredKeys<SettingsWriter> {
public:
    static constexpr bool reading = false;
    using StoredKeys::number;

    template <class Value>
    void field(std::string_view name, const Value& value) {
        begin(name);
        write(value);
    }
    template <class Value>
    void optional(std::string_view name, const std::optional<Value>& value) {
        if (value)
            field(name, *value);
    }
    /// True when an optional field is to be written.
    bool has(std::string_view, bool written) const { return written; }
    /// A value that is not stored but follows from fields: it is set when these are read.
    template <class Value>
    void follows(const Value&, const Value&) const {}
    /// An enumerator, by its number.
    template <class Choice>
    void number(std::string_view name, Choice choice, std::size_t) {
        field(name, static_cast<int>(choice));
    }
    /// The name of an enumerator, a parameter or what has this index; of several, their names.
    template <class Item>
    void named(std::string_view name, const Item& item, const std::vector<std::string>& names) {
        field(name, word_of(names, index_of(item)));
    }
    template <class Item>
    void named(std::string_view name, const std::vector<Item>& items, const std::vector<std::string>& names) {
        std::vector<std::string> texts;
        for (const Item& item : items)
            texts.push_back(word_of(names, index_of(item)));
        field(name, texts);
    }
    void expression(std::string_view name, const Expression& value) { field(name, to_string(value)); }
    void expressions(std::string_view name, const std::vector<Expression>& values) {
        std::vector<std::string> texts;
        for (const Expression& value : values)
            texts.push_back(to_string(value));
        field(name, texts);
    }
    /// @param describe is called with a visitor and each item
    template <class Item, class Describe>
    void list(std::string_view name, const std::vector<Item>& items, Describe describe) {
        begin(name);
        text_ += '[';
        for (std::size_t i = 0; i < items.size(); ++i) {
            SettingsWriter one;
            describe(one, items[i]);
            text_ += i > 0 ? "," : "";
            append(one);
        }
        text_ += ']';
    }
    template <class Describe>
    void object(std::string_view name, Describe describe) {
        SettingsWriter one;
        describe(one);
        begin(name);
        append(one);
    }
    std::string text() const { return "{" + text_ + "}"; }

private:
    void append(const SettingsWriter& other) {
        text_ += '{';
        text_ += other.text_;
        text_ += '}';
    }
    void begin(std::string_view name) { text_ += fmt::format("{}\"{}\":", text_.empty() ? "" : ",", name); }
    void write(double value) {
        if (!std::isfinite(value)) {
            text_ += std::isnan(value) ? "null" : value > 0 ? "\"inf\"" : "\"-inf\"";
            return;
        }
        // As by "{:.17g}" of fmt, which takes three times as long: a run may have ten million values.
        std::array<char, 32> digits;
        const auto written =
            std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 17);
        text_.append(digits.data(), written.ptr);
    }
    void write(bool value) { text_ += value ? "true" : "false"; }
    void write(std::uint64_t value) { text_ += fmt::format("{}", value); }
    void write(int value) { text_ += fmt::format("{}", value); }
    void write(const std::string& value) { text_ += json_text(value); }
    void write(const std::pair<double, double>& range) { write(std::vector<double>{range.first, range.second}); }
    template <class Item>
    void write(const std::vector<Item>& items) {
        text_ += '[';
        for (std::size_t i = 0; i < items.size(); ++i) {
            text_ += i > 0 ? "," : "";
            write(items[i]);
        }
        text_ += ']';
    }
    std::string text_;
};

/// Reads the fields of a JSON object. Fields that the object does not have keep their values.
class SettingsReader : public StoredKeys<SettingsReader> {
public:
    static constexpr bool reading = true;
    using StoredKeys::number;

    /// @param model whose names expressions use; null: there are no expressions
    SettingsReader(const Json& object, const Model* model, const Place& place)
        : object_(&object), model_(model), place_(&place) {
        if (object.kind != Json::Kind::object)
            fail("", "an object");
    }

    template <class Value>
    void field(std::string_view name, Value& value) const {
        if (const Json* found = object_->find(name))
            read(name, *found, value);
    }
    template <class Value>
    void optional(std::string_view name, std::optional<Value>& value) const {
        if (const Json* found = object_->find(name))
            read(name, *found, value.emplace());
    }
    bool has(std::string_view name, bool) const { return object_->find(name) != nullptr; }
    template <class Value>
    void follows(Value& target, const Value& value) const {
        target = value;
    }
    template <class Choice>
    void number(std::string_view name, Choice& choice, std::size_t count) const {
        std::size_t index = static_cast<std::size_t>(choice);
        field(name, index);
        if (index >= count)
            fail(name, fmt::format("a number below {}", count));
        choice = static_cast<Choice>(index);
    }
    template <class Item>
    void named(std::string_view name, Item& item, const std::vector<std::string>& names) const {
        std::string text;
        if (const Json* found = object_->find(name)) {
            read(name, *found, text);
            item = static_cast<Item>(index_among(name, text, names));
        }
    }
    template <class Item>
    void named(std::string_view name, std::vector<Item>& items, const std::vector<std::string>& names) const {
        std::vector<std::string> texts;
        field(name, texts);
        items.clear();
        for (const std::string& text : texts)
            items.push_back(static_cast<Item>(index_among(name, text, names)));
    }
    void expression(std::string_view name, Expression& value) const;
    void expressions(std::string_view name, std::vector<Expression>& values) const;
    template <class Item, class Describe>
    void list(std::string_view name, std::vector<Item>& items, Describe describe) const {
        const Json* found = object_->find(name);
        if (!found)
            return;
        items.clear();
        for (const Json& one : items_of(name, *found)) {
            SettingsReader reader(one, model_, *place_);
            describe(reader, items.emplace_back());
        }
    }
    template <class Describe>
    void object(std::string_view name, Describe describe) const {
        if (const Json* found = object_->find(name)) {
            SettingsReader reader(*found, model_, *place_);
            describe(reader);
        }
    }
    /// @throws InputError that says what a field should be
    [[noreturn]] void fail(std::string_view name, const std::string& wanted) const;

private:
    const std::vector<Json>& items_of(std::string_view name, const Json& json) const;
    std::size_t index_among(std::string_view name, const std::string& text,
                            const std::vector<std::string>& names) const;
    Expression parsed(const std::string& text) const;

    void read(std::string_view name, const Json& json, double& value) const;
    void read(std::string_view name, const Json& json, bool& value) const;
    void read(std::string_view name, const Json& json, std::string& value) const;
    void read(std::string_view name, const Json& json, std::uint64_t& value) const;
    void read(std::string_view name, const Json& json, int& value) const;
    void read(std::string_view name, const Json& json, std::pair<double, double>& range) const;
    template <class Item>
    void read(std::string_view name, const Json& json, std::vector<Item>& items) const {
        items.clear();
        for (const Json& one : items_of(name, json))
            read(name, one, items.emplace_back());
    }

    const Json* object_;
    const Model* model_;
    const Place* place_;
};

} // namespace graze
