#pragma once

#include "graze/acquire/instrument_line.hpp"

#include <deque>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace graze::testing {

/// A simulated line: a function of the test gives the answers to each sent line.
class ScriptedLine : public InstrumentLine {
public:
    using Answer = std::function<std::string(const std::string& said)>;
    explicit ScriptedLine(Answer answer) : answer_(std::move(answer)) {}

    void send(std::string_view line) override {
        require_there();
        said.emplace_back(line);
        std::istringstream lines(answer_(said.back()));
        for (std::string one; std::getline(lines, one);)
            answers_.push_back(one);
    }
    std::optional<std::string> receive(double) override {
        require_there();
        if (answers_.empty())
            return std::nullopt;
        std::string answer = std::move(answers_.front());
        answers_.pop_front();
        return answer;
    }
    void discard() override {
        require_there();
        answers_.clear();
    }
    void reopen() override {
        lost = lost && !mended_by_opening;
        require_there();
        answers_.clear();
    }

    std::vector<std::string> said;
    bool lost = false, mended_by_opening = true;

private:
    void require_there() const {
        if (lost)
            throw InstrumentError(AcquisitionEnding::line_lost, "it is cut off");
    }
    Answer answer_;
    std::deque<std::string> answers_;
};

} // namespace graze::testing
