// Records are read in parts: the time against reading the same bytes, from the disk and from memory.
#include "graze/base/text_file.hpp"
#include "graze/record/record_file.hpp"
#include "graze/record/record_writer.hpp"

#include <benchmark/benchmark.h>

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace {

constexpr std::size_t channels = 4;

/// Returns the number of rows of the record; GRAZE_RECORD_ROWS overrides it.
std::size_t wanted_rows() {
    const char* asked = std::getenv("GRAZE_RECORD_ROWS");
    return asked ? static_cast<std::size_t>(std::strtod(asked, nullptr)) : 1'000'000;
}

/// A temporary record as a 16-bit instrument writes it, in the folder GRAZE_RECORD_FOLDER.
class ExampleRecord {
public:
    explicit ExampleRecord(const char* ending) {
        const char* folder = std::getenv("GRAZE_RECORD_FOLDER");
        path_ = (folder ? std::filesystem::path(folder) : std::filesystem::temp_directory_path()) /
                ("graze-record-benchmark" + std::string(ending));
        graze::RecordWriter writer(path_, {{"t", "s"}, {{"V", "V"}, {"I", "A"}, {"q", "mm"}, {"v", "mm/s"}}});
        graze::Samples part;
        constexpr std::size_t part_rows = 10'000;
        for (std::size_t first = 0; first < wanted_rows(); first += part_rows) {
            part.clear(channels);
            for (std::size_t i = first; i < first + part_rows; ++i) {
                const double t = static_cast<double>(i) / 12800;
                part.times.push_back(t);
                for (std::size_t c = 0; c < channels; ++c)
                    part.values[c].push_back(std::round(30000 * std::sin(38 * t + static_cast<double>(c))) / 3276.8);
            }
            writer.write(part);
        }
        writer.close();
    }
    ~ExampleRecord() { std::filesystem::remove(path_); }
    ExampleRecord(const ExampleRecord&) = delete;
    ExampleRecord& operator=(const ExampleRecord&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

double seconds_of(const auto& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Drops a file from the page cache, so that it is read from the disk again.
void drop_from_cache(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY);
    fdatasync(file);
    posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
    ::close(file);
}

void read_bytes(const std::string& path) {
    graze::PlainFile file(path, "record");
    std::vector<char> buffer(std::size_t{4} << 20);
    while (file.read(buffer.data(), buffer.size()) > 0)
        benchmark::ClobberMemory();
}

std::size_t read_rows(const std::string& path) {
    const auto record = graze::open_record(path);
    graze::Samples samples;
    std::size_t rows = 0;
    while (record->read(samples))
        rows += samples.rows();
    return rows;
}

void read_record(benchmark::State& state, const char* ending) {
    const ExampleRecord record(ending);
    const auto size = static_cast<double>(std::filesystem::file_size(record.path()));
    double disk = 0, bytes = 0, rows = 0, count = 0;
    for ([[maybe_unused]] auto _ : state) {
        drop_from_cache(record.path());
        disk += seconds_of([&] { read_bytes(record.path()); });
        bytes += seconds_of([&] { read_bytes(record.path()); });
        drop_from_cache(record.path());
        rows += seconds_of([&] { count = static_cast<double>(read_rows(record.path())); });
    }
    const auto runs = static_cast<double>(state.iterations());
    state.counters["rows"] = count;
    state.counters["MB"] = size / 1e6;
    state.counters["MB_per_s"] = size / 1e6 * runs / rows;
    state.counters["disk_MB_per_s"] = size / 1e6 * runs / disk;
    state.counters["memory_MB_per_s"] = size / 1e6 * runs / bytes;
    state.counters["ratio_to_disk"] = rows / disk;
    state.counters["ratio_to_memory"] = rows / bytes;
    state.counters["numbers_per_s"] = count * (channels + 1) * runs / rows;
}

} // namespace

BENCHMARK_CAPTURE(read_record, text, ".csv")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_record, hdf5, ".h5")->Unit(benchmark::kMillisecond);
