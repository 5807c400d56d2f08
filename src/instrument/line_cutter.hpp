#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// Splits received text into lines, which end with carriage returns or line feeds.
class LineCutter {
public:
    explicit LineCutter(std::size_t longest) : longest_(longest) {}
    /// @param take called with each line, and whether it was too long, in which case it is truncated
    template <class Take>
    void add(std::string_view text, const Take& take) {
        for (const char letter : text) {
            if (letter == '\n' || letter == '\r') {
                if (!line_.empty())
                    take(line_, too_long_);
                line_.clear();
                too_long_ = false;
            } else if (line_.size() > longest_) {
                too_long_ = true;
            } else {
                line_ += letter;
            }
        }
    }
    /// Whether the present, incomplete line is already too long.
    bool is_too_long() const { return too_long_; }
    void clear() {
        line_.clear();
        too_long_ = false;
    }

private:
    std::size_t longest_;
    std::string line_;
    bool too_long_ = false;
};

} // namespace graze
