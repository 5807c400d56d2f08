#pragma once

#include "graze/acquire/instrument_line.hpp"
#include "instrument/sample_protocol.hpp"
#include "instrument/scpi_bench.hpp"

#include <deque>
#include <string>

namespace graze {

/// Line to the generator of a virtual bench in this process, in place of a serial line.
class BenchGeneratorLine : public InstrumentLine {
public:
    /// @param bench must outlive this object
    explicit BenchGeneratorLine(ScpiBench& bench) : bench_(&bench) {}
    void send(std::string_view line) override;
    std::optional<std::string> receive(double wait) override;
    void discard() override { answers_.clear(); }
    void reopen() override { answers_.clear(); }

private:
    ScpiBench* bench_;
    std::deque<std::string> answers_;
};

/// Line to the sample device of a virtual bench in this process. Its time passes as samples are read.
class BenchSampleLine : public InstrumentLine {
public:
    /// @param bench must outlive this object
    explicit BenchSampleLine(VirtualBench& bench) : protocol_(bench) {}
    void send(std::string_view line) override;
    std::optional<std::string> receive(double wait) override;
    void discard() override {
        text_.clear();
        begin_ = 0;
    }
    void reopen() override;

private:
    SampleProtocol protocol_;
    std::string text_;
    std::size_t begin_ = 0; ///< start of the unread text
};

} // namespace graze
