#include "instrument/sample_protocol.hpp"

#include "base/read_whole.hpp"
#include "graze/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace graze {

namespace {

constexpr std::size_t most_waiting = 64;

} // namespace

bool SampleProtocol::receive(std::string_view line) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' '))
        line.remove_suffix(1);
    if (line.empty())
        return true;
    if (line == "STOP" && reading_) {
        wanted_ = given_;
        return true;
    }
    if (line == "MORE") {
        allowed_ = std::min(allowed_ + block_, most_rows);
        return true;
    }
    if (waiting_.size() == most_waiting || line.size() > longest_line)
        return false;
    waiting_.emplace_back(line);
    return true;
}

void SampleProtocol::forget() {
    waiting_.clear();
    reading_ = false;
}

std::string SampleProtocol::next(std::size_t rows_at_most, double until) {
    if (!reading_) {
        if (waiting_.empty())
            return {};
        const std::string line = std::move(waiting_.front());
        waiting_.pop_front();
        return answer(line);
    }
    std::size_t count = std::min(rows_at_most, std::min(wanted_, std::max(allowed_, given_)) - given_);
    if (count == 0 && given_ < wanted_)
        return {};
    if (std::isfinite(until)) {
        const double due = std::floor((until - bench_->time()) * bench_->rate());
        count = due < 1 ? 0 : std::min(count, static_cast<std::size_t>(std::min(due, 1e9)));
        if (count == 0 && given_ < wanted_)
            return {};
    }
    std::string text = rows(count);
    if (!bench_->ended().empty() && given_ < wanted_) {
        reading_ = false;
        return text + fmt::format("ERROR {}\n", printable_line(bench_->ended()));
    }
    if (given_ == wanted_) {
        reading_ = false;
        text += fmt::format("END {}\n", given_);
    }
    return text;
}

std::string SampleProtocol::rows(std::size_t count) {
    std::string text;
    if (count == 0)
        return text;
    bench_->sample(count, samples_);
    for (std::size_t row = 0; row < samples_.rows(); ++row, ++given_) {
        fmt::format_to(std::back_inserter(text), "{}", static_cast<double>(given_) / bench_->rate());
        for (const std::vector<double>& column : samples_.values)
            fmt::format_to(std::back_inserter(text), ",{}", column[row]);
        text += '\n';
    }
    return text;
}

std::string SampleProtocol::answer(std::string_view line) {
    const std::size_t blank = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, blank);
    const std::string_view rest = blank < line.size() ? line.substr(blank + 1) : std::string_view();
    if (word == "CHANNELS" && rest.empty())
        return bench_->header().heading() + '\n';
    if (double rate = 0; word == "RATE" && read_whole(rest, rate)) {
        try {
            bench_->set_rate(rate);
        } catch (const InputError& error) {
            return fmt::format("ERROR {}\n", error.what());
        }
        return fmt::format("OK {}\n", bench_->rate());
    }
    if (word == "READ") {
        const std::size_t gap = std::min(rest.find(' '), rest.size());
        std::size_t count = 0, block = most_rows;
        const bool good = read_whole(rest.substr(0, gap), count) && count <= most_rows &&
                          (gap == rest.size() || (read_whole(rest.substr(gap + 1), block) && block > 0));
        if (good) {
            reading_ = true;
            wanted_ = count;
            given_ = 0;
            block_ = allowed_ = std::min(block, most_rows);
            return {};
        }
    }
    if (std::uint64_t number = 0; (word == "MARK" || word == "RETURN") && read_whole(rest, number)) {
        if (word == "MARK")
            bench_->mark(number);
        else if (!bench_->return_to(number))
            return fmt::format("ERROR nothing is marked by {}\n", number);
        return "OK\n";
    }
    if (line == "STOP")
        return "END 0\n";
    return fmt::format("ERROR '{}' is not understood\n", printable_line(line));
}

} // namespace graze
