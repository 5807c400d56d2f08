#pragma once

#include "base/temporary_folder.hpp"
#include "program/program.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace graze::testing {

/// Exit code, standard output and standard error of a command.
struct Printed {
    int code;
    std::string out, err;
};

/// Runs the program in this process. @param arguments without the program's name
inline Printed run_graze(const std::vector<std::string>& arguments) {
    std::ostringstream out, err;
    const int code = run_program(arguments, {out, err, false});
    return {code, out.str(), err.str()};
}

/// The words of a line; no word contains blanks.
inline std::vector<std::string> words_of(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        words.push_back(word);
    return words;
}
inline Printed run_graze(const std::string& line) {
    return run_graze(words_of(line));
}

/// The program must have succeeded. @return standard output
inline std::string done(const Printed& printed) {
    EXPECT_EQ(printed.code, exit_success) << printed.err;
    return printed.out;
}
inline std::string done(const std::vector<std::string>& arguments) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    return done(run_graze(arguments));
}
inline std::string done(const std::string& line) {
    return done(words_of(line));
}

/// The program must have refused its arguments, in one line that contains this message and a remedy.
inline void expect_refusal(const Printed& printed, const std::string& message) {
    EXPECT_EQ(printed.code, exit_bad_input) << printed.err;
    EXPECT_EQ(printed.out, "");
    EXPECT_TRUE(printed.err.starts_with("graze: ")) << printed.err;
    EXPECT_THAT(printed.err, ::testing::HasSubstr(message));
    EXPECT_THAT(printed.err, ::testing::HasSubstr("; "));
    EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
}
inline void expect_refusal(const std::vector<std::string>& arguments, const std::string& message) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    expect_refusal(run_graze(arguments), message);
}
inline void expect_refusal(const std::string& line, const std::string& message) {
    expect_refusal(words_of(line), message);
}

/// Computes these runs of a study, and those that they start from. @return the folder of the results
inline std::string run_only(const std::string& study, const std::vector<std::string>& runs, const std::string& folder) {
    std::vector<std::string> words{"run", study, "--output", folder, "--quiet"};
    for (const std::string& run : runs)
        words.insert(words.end(), {"--only", run});
    done(words);
    return folder;
}

inline std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);)
        parts.push_back(part);
    if (!text.empty() && text.back() == separator && separator != '\n')
        parts.emplace_back();
    return parts;
}

/// A CSV table without quoted cells.
struct Csv {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    explicit Csv(const std::string& text) {
        for (const std::string& line : split(text, '\n')) {
            if (columns.empty())
                columns = split(line, ',');
            else
                rows.push_back(split(line, ','));
        }
        for (const auto& row : rows)
            EXPECT_EQ(row.size(), columns.size());
    }
    const std::string& text(std::size_t row, const std::string& column) const {
        const auto found = std::find(columns.begin(), columns.end(), column);
        EXPECT_NE(found, columns.end()) << column;
        return rows.at(row).at(static_cast<std::size_t>(found - columns.begin()));
    }
    double number(std::size_t row, const std::string& column) const {
        return std::strtod(text(row, column).c_str(), nullptr);
    }
};

inline std::string header(const std::string& out) {
    return out.substr(0, out.find('\n'));
}

using Folder = TemporaryFolder;

/// Checks whether a text is one JSON value (RFC 8259).
class JsonCheck {
public:
    explicit JsonCheck(std::string_view text) : rest_(text) {}
    bool valid() { return value() && (blanks(), rest_.empty()); }

private:
    void blanks() {
        while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_[0])) != 0)
            rest_.remove_prefix(1);
    }
    bool take(std::string_view token) {
        blanks();
        if (!rest_.starts_with(token))
            return false;
        rest_.remove_prefix(token.size());
        return true;
    }
    bool value() {
        if (take("{"))
            return members('}', true);
        if (take("["))
            return members(']', false);
        if (take("null") || take("true") || take("false"))
            return true;
        return rest_.starts_with('"') ? string() : number();
    }
    bool members(char end, bool named) {
        const std::string_view close(&end, 1);
        if (take(close))
            return true;
        do {
            if (named && !((blanks(), string()) && take(":")))
                return false;
            if (!value())
                return false;
        } while (take(","));
        return take(close);
    }
    bool string() {
        if (rest_.empty() || rest_[0] != '"')
            return false;
        for (std::size_t i = 1; i < rest_.size(); ++i) {
            if (static_cast<unsigned char>(rest_[i]) < 0x20)
                return false;
            if (rest_[i] == '\\') {
                ++i;
            } else if (rest_[i] == '"') {
                rest_.remove_prefix(i + 1);
                return true;
            }
        }
        return false;
    }
    bool number() {
        const std::size_t length = std::min(rest_.find_first_not_of("+-.0123456789eE"), rest_.size());
        const std::string digits(rest_.substr(0, length));
        char* end = nullptr;
        std::strtod(digits.c_str(), &end);
        const bool whole =
            !digits.empty() && end == digits.c_str() + digits.size() && digits[0] != '+' && digits[0] != '.';
        rest_.remove_prefix(length);
        return whole;
    }

    std::string_view rest_;
};

} // namespace graze::testing
