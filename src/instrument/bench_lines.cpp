#include "instrument/bench_lines.hpp"

namespace graze {

void BenchGeneratorLine::send(std::string_view line) {
    std::string answer = bench_->command(line);
    if (!answer.empty())
        answers_.push_back(std::move(answer));
}

std::optional<std::string> BenchGeneratorLine::receive(double) {
    if (answers_.empty())
        return std::nullopt;
    std::string answer = std::move(answers_.front());
    answers_.pop_front();
    return answer;
}

void BenchSampleLine::send(std::string_view line) {
    if (!protocol_.receive(line))
        throw InstrumentError(AcquisitionEnding::samples, "the bench is asked for too much at once");
}

std::optional<std::string> BenchSampleLine::receive(double) {
    for (;;) {
        const std::size_t end = text_.find('\n', begin_);
        if (end != std::string::npos) {
            std::string line = text_.substr(begin_, end - begin_);
            begin_ = end + 1;
            return line;
        }
        const bool reading = protocol_.is_reading();
        text_ = protocol_.next(SampleProtocol::rows_at_once);
        begin_ = 0;
        if (text_.empty() && protocol_.is_reading() == reading)
            return std::nullopt;
    }
}

void BenchSampleLine::reopen() {
    protocol_.forget();
    text_.clear();
    begin_ = 0;
}

} // namespace graze
