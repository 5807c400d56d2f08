#pragma once

#include "graze/bench/virtual_bench.hpp"
#include "graze/record/samples.hpp"
#include "graze/study/record_request.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace graze {

/// Records of a virtual bench whose motion goes on from level to level, or begins anew at each level. A record does not
/// depend on which others are asked for: where the motion goes on, the levels before it are passed without being kept.
class BenchRecords {
public:
    /// @param bench must outlive this
    explicit BenchRecords(const RecordBench& bench) : bench_(&bench) {}

    const RecordHeader& header() const { return header_; }
    /// @return nothing when it was interrupted. @throws InputError when the motion ends
    std::optional<Samples> record(std::size_t number, const std::function<bool()>& interrupted);

private:
    void begin(std::size_t number);
    void drive(double amplitude);
    bool take(std::size_t level, const std::function<bool()>& interrupted, Samples& samples);

    const RecordBench* bench_;
    std::unique_ptr<VirtualBench> instrument_;
    std::size_t next_ = 0; ///< record that the instrument would make
    double factor_ = 1;    ///< of the parameter, by the amplitude of the generator
    RecordHeader header_;
};

} // namespace graze
