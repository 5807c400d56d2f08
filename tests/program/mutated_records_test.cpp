// Records with random or malicious changes.

#include "graze/record/record_writer.hpp"
#include "mutated_files.hpp"

#include <cmath>

namespace graze::testing::mutated_records_test {

/// A displacement and its velocity, which jumps twice in each period.
Samples motion(int rows) {
    Samples samples;
    samples.values.resize(2);
    for (int i = 0; i < rows; ++i) {
        const double t = i * 0.05;
        samples.times.push_back(t);
        samples.values[0].push_back(std::abs(std::sin(t)) - 0.5);
        samples.values[1].push_back(std::sin(t) < 0 ? -std::cos(t) : std::cos(t));
    }
    return samples;
}

std::string record_of(const std::string& path, int rows) {
    RecordWriter writer(path, {{"t", "s"}, {{"x", "mm"}, {"v", "mm/s"}}});
    writer.write(motion(rows));
    writer.close();
    return contents(path);
}

const std::vector<UseOfFile> uses{
    {{"record", "FILE"}},
    {{"record", "FILE", "--what", "samples"}},
    {{"record", "FILE", "--what", "periods"}},
    {{"record", "FILE", "--what", "sections", "--reference", "x", "--phase", "0,0.5", "--negate", "v"}},
    {{"record", "FILE", "--what", "extremes", "--format", "csv"}},
    {{"record", "FILE", "--what", "spectrum", "--channel", "x"}},
    {{"record", "FILE", "--what", "impacts", "--channel", "v", "--displacement", "x", "--window", "6"}},
    {{"record", "FILE", "--every", "2", "--write", "OUT/w.h5"}},
    {{"record", "FILE", "--derivative", "x", "--write", "OUT/w.csv"}},
    {{"identify", "decrement", "FILE", "--peaks", "2"}},
    {{"identify", "restitution", "FILE", "--window", "6", "--displacement", "x"}},
    {{"identify", "coupling", "FILE", "--gap", "2", "--stiffness", "1", "--displacement", "x", "--current", "v"}},
    {{"identify", "impedance", "FILE", "--voltage", "x", "--current", "v"}},
    {{"info", "FILE"}},
};

TEST_F(MutatedFiles, TextRecordsAreUsedOrRefused) {
    try_texts("r.csv", {record_of(folder / "whole.csv", 200)}, uses, 2 * uses.size());
}

TEST_F(MutatedFiles, Hdf5RecordsAreUsedOrRefused) {
    try_bytes("r.h5", record_of(folder / "whole.h5", 100), uses, 2 * uses.size());
}

} // namespace graze::testing::mutated_records_test
