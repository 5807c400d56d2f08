#include "graze/results/hdf5.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace graze {
namespace {

/// A dataset of an HDF5 file.
class Column {
public:
    Column(const std::string& file, const std::string& name)
        : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)), set_(H5Dopen2(file_, name.c_str(), H5P_DEFAULT)) {}
    ~Column() {
        H5Dclose(set_);
        H5Fclose(file_);
    }
    Column(const Column&) = delete;
    Column& operator=(const Column&) = delete;

    H5T_class_t type() const {
        const hid_t type = H5Dget_type(set_);
        const H5T_class_t result = H5Tget_class(type);
        H5Tclose(type);
        return result;
    }
    std::vector<double> numbers() const {
        const hid_t space = H5Dget_space(set_);
        std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
        H5Sclose(space);
        H5Dread(set_, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        return values;
    }

private:
    hid_t file_, set_;
};

/// A run with one orbit of the linear impact oscillator.
void write_branch(const std::string& path) {
    const Model model = load_model("impact-oscillator");
    RunRecord run;
    run.name = "b";
    run.kind = "continue";
    run.model_name = model.name;
    run.model = write_model(model);
    for (const auto& symbol : model.parameter_symbols())
        run.coordinates.push_back({symbol.name(), ""});
    for (const State& state : model.states)
        run.states.push_back({state.name, ""});
    run.values = {{"period", ""}, {"speed", "m/s"}};
    OrbitRecord record;
    record.part = "up";
    record.label = "GR1";
    record.point.type = PointType::grazing;
    record.point.monitors = {2.5, 0.25};
    record.point.solution.outcome = OrbitOutcome::converged;
    record.point.solution.multipliers = {{0.5, 0.25}, {0.5, -0.25}};
    record.point.solution.half_multipliers = {{std::numeric_limits<double>::infinity(), 0}};
    record.point.solution.certificate.minima = {{0, 1, 0.5, 0.125, 2}};
    record.point.solution.certificate.end_values = {{0, 1, 0.25, -3}};
    Orbit& orbit = record.point.solution.orbit;
    orbit.signature = parse_signature(model, "impact");
    orbit.parameters = model.parameter_values();
    orbit.starts = {{0.1, -0.5, 1.5}};
    orbit.durations = {2.5};
    ResultFile file(path, ResultFile::Access::write);
    file.begin_run(run);
    file.add_orbit("b", record);
    file.complete_run("b");
}

TEST(Hdf5, branches_have_orbits_segments_and_multipliers) {
    const auto folder = std::filesystem::temp_directory_path() / ("graze-hdf5-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string path = (folder / "results.sqlite").string(), exported = (folder / "all.h5").string();
    write_branch(path);
    export_hdf5(ResultFile(path, ResultFile::Access::read), {"b"}, exported);
    EXPECT_EQ(Column(exported, "b/orbits/label").type(), H5T_STRING);
    EXPECT_EQ(Column(exported, "b/orbits/signature").type(), H5T_STRING);
    EXPECT_EQ(Column(exported, "b/orbits/step").type(), H5T_INTEGER);
    EXPECT_EQ(Column(exported, "b/orbits/stable").type(), H5T_INTEGER);
    // A monitor whose name is taken gets another, and stays a real number.
    EXPECT_EQ(Column(exported, "b/orbits/period_2").numbers(), std::vector<double>{2.5});
    EXPECT_EQ(Column(exported, "b/orbits/period_2").type(), H5T_FLOAT);
    EXPECT_EQ(Column(exported, "b/orbits/speed").numbers(), std::vector<double>{0.25});
    EXPECT_EQ(Column(exported, "b/orbits/omega").numbers(), std::vector<double>{2.5});
    EXPECT_EQ(Column(exported, "b/segments/segment").type(), H5T_INTEGER);
    EXPECT_EQ(Column(exported, "b/segments/mode").type(), H5T_STRING);
    EXPECT_EQ(Column(exported, "b/segments/start_v").numbers(), std::vector<double>{-0.5});
    EXPECT_EQ(Column(exported, "b/multipliers/imaginary").numbers(), (std::vector<double>{0.25, -0.25}));
    EXPECT_EQ(Column(exported, "b/half_multipliers/real").numbers(),
              std::vector<double>{std::numeric_limits<double>::infinity()});
    EXPECT_EQ(Column(exported, "b/minima/value").numbers(), std::vector<double>{0.125});
    EXPECT_EQ(Column(exported, "b/minima/event").type(), H5T_STRING);
    EXPECT_EQ(Column(exported, "b/end_values/rate").numbers(), std::vector<double>{-3});
    EXPECT_EQ(Column(exported, "b/end_values/segment").type(), H5T_INTEGER);
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace graze
