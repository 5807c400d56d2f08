#include "study/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>

namespace graze {

namespace {

constexpr int deepest = 32;

/// Reads a text from its beginning to its end.
class JsonReader {
public:
    JsonReader(std::string_view text, const Place& place) : text_(text), place_(&place) {}

    Json read() {
        Json value = read_value(0);
        skip_blanks();
        if (at_ < text_.size())
            fail("something follows its end");
        return value;
    }

private:
    [[noreturn]] void fail(const std::string& why) const {
        throw InputError(*place_, fmt::format("this is no JSON: {} (at character {})", why, at_ + 1),
                         "the result file has been changed or damaged: ask for another copy");
    }
    void skip_blanks() {
        while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
            ++at_;
    }
    char peek() {
        skip_blanks();
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) {
        if (peek() != c)
            return false;
        ++at_;
        return true;
    }
    void require(char c) {
        if (!take(c))
            fail(fmt::format("'{}' is missing", c));
    }
    bool take_word(std::string_view word) {
        if (text_.substr(at_, word.size()) != word)
            return false;
        at_ += word.size();
        return true;
    }

    Json read_value(int depth) {
        if (depth > deepest)
            fail("it is nested too deeply");
        Json value;
        const char c = peek();
        if (c == '{')
            read_members(value, depth);
        else if (c == '[')
            read_items(value, depth);
        else if (c == '"')
            value.kind = Json::Kind::text, value.text = read_text();
        else if (take_word("true") || take_word("false"))
            value.kind = Json::Kind::truth, value.truth = c == 't';
        else if (!take_word("null"))
            value.kind = Json::Kind::number, value.text = read_number();
        return value;
    }
    /// Reads what stands between two brackets. @param read_item called for each item, or member
    template <class ReadItem>
    void read_between(char open, char close, const ReadItem& read_item) {
        require(open);
        if (take(close))
            return;
        do
            read_item();
        while (take(','));
        require(close);
    }
    void read_members(Json& value, int depth) {
        value.kind = Json::Kind::object;
        read_between('{', '}', [&] {
            if (peek() != '"')
                fail("a name is missing");
            value.names.push_back(read_text());
            require(':');
            value.items.push_back(read_value(depth + 1));
        });
    }
    void read_items(Json& value, int depth) {
        value.kind = Json::Kind::list;
        read_between('[', ']', [&] { value.items.push_back(read_value(depth + 1)); });
    }
    std::string read_number() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && std::string_view("+-0123456789.eE").find(text_[at_]) != std::string_view::npos)
            ++at_;
        if (at_ == begin)
            fail("a value is missing");
        return std::string(text_.substr(begin, at_ - begin));
    }
    std::string read_text() {
        require('"');
        std::string result;
        while (at_ < text_.size() && text_[at_] != '"') {
            if (text_[at_] != '\\') {
                result += text_[at_++];
                continue;
            }
            if (++at_ >= text_.size())
                break;
            const char c = text_[at_++];
            if (c == 'u')
                result += read_code();
            else if (const auto known = std::string_view("bfnrt").find(c); known != std::string_view::npos)
                result += "\b\f\n\r\t"[known];
            else
                result += c;
        }
        if (at_ >= text_.size())
            fail("a text does not end");
        ++at_;
        return result;
    }
    /// Only control characters are written in this way.
    char read_code() {
        unsigned code = 0;
        const std::string_view digits = text_.substr(at_, 4);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
        if (error != std::errc() || end != digits.data() + 4 || code >= 0x80)
            fail("a character cannot be read");
        at_ += 4;
        return static_cast<char>(code);
    }

    std::string_view text_;
    const Place* place_;
    std::size_t at_ = 0;
};

} // namespace

const Json* Json::find(std::string_view name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? nullptr : &items[static_cast<std::size_t>(found - names.begin())];
}

Json parse_json(std::string_view text, const Place& place) {
    return JsonReader(text, place).read();
}

} // namespace graze
