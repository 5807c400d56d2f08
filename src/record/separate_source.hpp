#pragma once

#include "graze/record/samples.hpp"

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>

namespace graze {

/// Resources that the process that reads a file may use.
struct ReadingLimits {
    std::size_t memory = std::size_t{768} << 20; ///< bytes, in addition to those of the calling process
    double work = 2;                             ///< seconds of processor time for the header, and for each part
    double silence = 60;                         ///< seconds of waiting for the header, and for each part
};

/// A source that is opened and read in a process of its own (fork), for libraries that crash, hang or exhaust memory on
/// a damaged file: such a failure becomes an InputError here. The process opens one file at most, writes none, and ends
/// with this object. It reads ahead while parts are processed here.
class SeparateSource : public SampleSource {
public:
    using Make = std::function<std::unique_ptr<SampleSource>()>;

    /// @param path of the file, for messages; @param make opens the source, in the other process
    /// @throws InputError that `make` has thrown, or when the process has died
    SeparateSource(std::string path, const Make& make, const ReadingLimits& limits = {});
    ~SeparateSource() override;
    const RecordHeader& header() const override { return header_; }
    /// @throws InputError that the source has thrown, or when the process has died
    bool read(Samples& samples) override;

private:
    void fill(void* to, std::size_t size);
    char next_kind();
    std::uint64_t next_number(std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
    std::string next_text();
    [[noreturn]] void pass_on_refusal();
    [[noreturn]] void tell_end(bool silent);
    [[noreturn]] void tell_nonsense();
    int end(bool at_once);

    std::string path_;
    ReadingLimits limits_;
    RecordHeader header_;
    pid_t process_ = -1;
    int pipe_ = -1;
    bool complete_ = false; ///< the end was reached without an error
};

} // namespace graze
