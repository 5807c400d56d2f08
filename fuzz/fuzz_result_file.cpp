// For any modified result file, reading either succeeds or throws an InputError. An input that begins with S is an SQL
// script that is applied to a valid file; any other input changes bytes of one, four input bytes per change.

#include "graze/base/input_error.hpp"
#include "graze/results/result_file.hpp"

#include <sqlite3.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

constexpr const char* model = R"(
name = "ball"
[parameters]
g = 1
[states]
x = 0
v = 1
[modes.flight]
rates = { x = "v", v = "-g" }
watch = ["floor"]
[events]
floor = "x"
[jumps.bounce]
v = "-v"
[[transitions]]
mode = "flight"
event = "floor"
label = "bounce"
jump = "bounce"
next = "flight"
)";

graze::RunRecord run_of(const char* kind) {
    graze::RunRecord run;
    run.name = run.kind = kind;
    run.model = model;
    run.settings = "{}";
    run.states = {{"x", "m"}, {"v", ""}};
    run.values = {{"v", ""}};
    run.modes = {"flight"};
    if (run.is_branch()) {
        run.coordinates = {{"g", ""}};
    } else {
        run.coordinates = {{"x", "m"}};
        run.samplings = {"s"};
        run.directions = {"up"};
    }
    return run;
}

std::string path() {
    static const std::string name = [] {
        const std::filesystem::path memory = "/dev/shm";
        const auto folder = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
        return (folder / ("graze-fuzz-" + std::to_string(getpid()) + ".sqlite")).string();
    }();
    return name;
}

void remove_files() {
    for (const char* ending : {"", "-wal", "-shm", "-journal", ".lock"})
        std::filesystem::remove(path() + ending);
}

/// Returns the bytes of a file with a run of each kind.
std::string make_image() {
    {
        graze::ResultFile file(path(), graze::ResultFile::Access::write);
        file.begin_run(run_of("basin"));
        for (std::size_t number = 0; number < 3; ++number) {
            graze::PointRecord point;
            point.number = number;
            point.coordinates = {1};
            point.result.state = {1, 2};
            point.result.multipliers = {{0.5, 0}};
            point.result.samples.width = 1;
            point.result.samples.samplings = {0};
            point.result.samples.times = {0};
            point.result.samples.values = {1};
            file.add_point("basin", point);
        }
        file.begin_run(run_of("continue"));
        graze::OrbitRecord orbit;
        orbit.label = "GR1";
        orbit.point.type = graze::PointType::grazing;
        orbit.point.solution.orbit.signature.push_back({});
        orbit.point.solution.orbit.parameters = {1};
        orbit.point.solution.orbit.starts = {{0, 1}};
        orbit.point.solution.orbit.durations = {2};
        orbit.point.solution.multipliers = {{0.5, 0}};
        file.add_orbit("continue", orbit);
    }
    std::ifstream stream(path(), std::ios::binary);
    std::string image{std::istreambuf_iterator<char>(stream), {}};
    std::atexit(remove_files);
    return image;
}

void carry_out(const std::string& script) {
    sqlite3* database = nullptr;
    if (sqlite3_open(path().c_str(), &database) == SQLITE_OK) {
        sqlite3_limit(database, SQLITE_LIMIT_LENGTH, 1 << 24);
        sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
        sqlite3_progress_handler(
            database, 1'000'000, [](void*) { return 1; }, nullptr); // limits the run time of scripts
        sqlite3_exec(database, script.c_str(), nullptr, nullptr, nullptr);
    }
    sqlite3_close(database);
}

template <class Read>
void attempt(Read read) {
    try {
        read();
    } catch (const graze::InputError&) {
        return;
    }
}

void read_all() {
    graze::ResultFile file(path(), graze::ResultFile::Access::read);
    file.set_patience(std::chrono::milliseconds(100));
    for (const graze::RunRecord& run : file.runs()) {
        attempt([&] { graze::stored_model(run); });
        attempt([&] { file.point_count(run.name); });
        attempt([&] {
            const auto next = file.last_points(run.name, 2);
            while (next()) {
            }
        });
        attempt([&] {
            const auto next = file.point_numbers(run.name);
            while (next()) {
            }
        });
        attempt([&] { file.point(run.name, 1); });
        attempt([&] { file.nearest_point(run.name, "x", 1, 0); });
        attempt([&] { file.orbits(run.name, false); });
        attempt([&] { file.orbit(run.name, "GR1"); });
    }
    for (const char* sql : {"SELECT * FROM all_points", "SELECT * FROM special_points", "SELECT * FROM multipliers"})
        attempt([&] {
            auto rows = file.query(sql);
            for (int i = 0; i < 1000 && rows.next(); ++i)
                for (std::size_t c = 0; c < rows.columns(); ++c)
                    rows.text(c);
        });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string image = make_image();
    std::string bytes = image;
    const bool script = size > 0 && data[0] == 'S';
    for (std::size_t i = 0; !script && i + 4 <= size; i += 4) {
        const std::size_t at = (data[i] * 65536u + data[i + 1] * 256u + data[i + 2]) % bytes.size();
        bytes[at] = static_cast<char>(data[i + 3]);
    }
    remove_files();
    std::ofstream(path(), std::ios::binary) << bytes;
    if (script)
        carry_out({reinterpret_cast<const char*>(data) + 1, size - 1});
    attempt(read_all);
    return 0;
}
