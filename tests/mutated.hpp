#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace graze::testing {

inline std::size_t below(std::mt19937& random, std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// A file, some of whose bytes are changed as by a fault or on purpose; sometimes it is cut off.
inline std::string mutated_bytes(const std::string& whole, std::mt19937& random) {
    std::string bytes = whole;
    for (std::size_t changes = 1 + below(random, 4); changes > 0; --changes) {
        const std::size_t at = below(random, bytes.size());
        switch (below(random, 5)) {
        case 0:
            bytes[at] = static_cast<char>(below(random, 256));
            break;
        case 1:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 8)));
            break;
        case 2:
            bytes[at] = "\x00\x01\x7f\x80\xff"[below(random, 5)];
            break;
        case 3: { // a piece from elsewhere
            const std::size_t from = below(random, bytes.size()), length = 1 + below(random, 32);
            for (std::size_t i = 0; i < length && at + i < bytes.size() && from + i < bytes.size(); ++i)
                bytes[at + i] = bytes[from + i];
            break;
        }
        default:
            if (below(random, 8) == 0)
                bytes.resize(std::max<std::size_t>(at, 9));
        }
    }
    return bytes;
}

/// Words that mean something somewhere, and numbers that are too much.
inline const std::vector<std::string>& strange_words() {
    static const std::vector<std::string> words{"0",
                                                "-1",
                                                "1e300",
                                                "-1e300",
                                                "1e-300",
                                                "5e-324",
                                                "nan",
                                                "inf",
                                                "-inf",
                                                "9223372036854775807",
                                                "1e999",
                                                "0x7f",
                                                "1_000",
                                                "999999999",
                                                "true",
                                                "[]",
                                                "{}",
                                                "\"\"",
                                                "\"x\"",
                                                "\"(\"",
                                                "\"sin(\"",
                                                "\"1/0\"",
                                                "\"x^x^x\"",
                                                "\"sqrt(-x)\"",
                                                "\"log(0)\"",
                                                "\"if(x > 0, 1, 0/0)\"",
                                                "\"..\"",
                                                "\"/dev/zero\"",
                                                "\"s.toml\"",
                                                "\"m.toml\"",
                                                "name",
                                                "[[a]]",
                                                "[a.b]",
                                                "= =",
                                                "'",
                                                "\"\"\"",
                                                "\xff",
                                                "\x1b[2J",
                                                "\xe2\x80\xae",
                                                "#",
                                                ",",
                                                "\n",
                                                "\t",
                                                "1e1000000",
                                                "00",
                                                "--1",
                                                "1..2"};
    return words;
}

/// A text in which some words are replaced, left out or doubled, and some lines are moved.
inline std::string mutated_words(const std::string& whole, std::mt19937& random) {
    std::vector<std::string> parts; // words, and what is between them
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.";
    for (const char c : whole) {
        const bool word = letters.find(c) != std::string_view::npos;
        if (parts.empty() || !word || letters.find(parts.back()[0]) == std::string_view::npos)
            parts.emplace_back();
        parts.back() += c;
    }
    for (std::size_t changes = 1 + below(random, 3); changes > 0; --changes) {
        const std::size_t at = below(random, parts.size()), other = below(random, parts.size());
        switch (below(random, 6)) {
        case 0:
            parts[at].clear();
            break;
        case 1:
            parts[at] = parts[other];
            break;
        case 2:
            parts[at] += parts[at];
            break;
        case 3: { // all from there to there once more
            const std::size_t length = std::min<std::size_t>({other, parts.size() - at, 60});
            parts[at] = std::string("\n");
            for (std::size_t i = 0; i < length; ++i)
                parts[at] += parts[at + i];
            break;
        }
        default:
            parts[at] = strange_words()[below(random, strange_words().size())];
        }
    }
    std::string text;
    for (const std::string& part : parts)
        text += part;
    return text;
}

} // namespace graze::testing
