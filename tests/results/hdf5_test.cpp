#include "graze/results/hdf5.hpp"

#include "graze/model/catalogue.hpp"

#include "base/temporary_folder.hpp"
#include "run_of_model.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace graze::hdf5_test {

/// A dataset of an HDF5 file.
class Column {
    template <class Property>
    auto of_type(Property property) const {
        const hid_t type = H5Dget_type(set_);
        const auto result = property(type);
        H5Tclose(type);
        return result;
    }

public:
    Column(const std::string& file, const std::string& name)
        : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)), set_(H5Dopen2(file_, name.c_str(), H5P_DEFAULT)) {}
    ~Column() {
        H5Dclose(set_);
        H5Fclose(file_);
    }
    Column(const Column&) = delete;
    Column& operator=(const Column&) = delete;

    H5T_class_t type() const { return of_type(H5Tget_class); }
    std::size_t rows() const {
        const hid_t space = H5Dget_space(set_);
        const auto rows = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
        H5Sclose(space);
        return rows;
    }
    std::vector<double> numbers() const {
        std::vector<double> values(rows());
        H5Dread(set_, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        return values;
    }
    /// Number of bytes of each text; 0 if texts have variable length.
    std::size_t width() const { return of_type(H5Tis_variable_str) > 0 ? 0 : of_type(H5Tget_size); }
    H5T_cset_t letters() const { return of_type(H5Tget_cset); }
    std::vector<std::string> texts() const {
        const hid_t type = H5Dget_type(set_);
        std::vector<std::string> texts;
        if (width() == 0) {
            std::vector<char*> pointers(rows());
            H5Dread(set_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data());
            for (char* pointer : pointers) {
                texts.emplace_back(pointer);
                H5free_memory(pointer);
            }
        } else {
            std::string all(rows() * width(), '?');
            H5Dread(set_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
            for (std::size_t r = 0; r < rows(); ++r) {
                const std::string cell = all.substr(r * width(), width());
                texts.push_back(cell.substr(0, cell.find('\0')));
            }
        }
        H5Tclose(type);
        return texts;
    }
    /// Number of rows of a chunk; 0 if the column is not chunked.
    std::size_t chunk() const {
        const hid_t properties = H5Dget_create_plist(set_);
        hsize_t chunk = 0;
        if (H5Pget_layout(properties) == H5D_CHUNKED)
            H5Pget_chunk(properties, 1, &chunk);
        H5Pclose(properties);
        return static_cast<std::size_t>(chunk);
    }
    std::size_t stored_bytes() const { return static_cast<std::size_t>(H5Dget_storage_size(set_)); }
    std::string units() const {
        if (H5Aexists(set_, "units") <= 0)
            return "none";
        const hid_t attribute = H5Aopen(set_, "units", H5P_DEFAULT), type = H5Aget_type(attribute);
        char* text = nullptr;
        H5Aread(attribute, type, &text);
        std::string units = text;
        H5free_memory(text);
        H5Tclose(type);
        H5Aclose(attribute);
        return units;
    }

private:
    hid_t file_, set_;
};

class Hdf5 : public ::testing::Test {
protected:
    std::string path(const char* name) const { return folder_ / name; }

    testing::TemporaryFolder folder_;
};

/// Writes a run of the linear impact oscillator with copies of one orbit, each changed by a function of its number.
void write_branch(
    const std::string& path, std::size_t orbits = 1,
    const std::function<void(OrbitRecord&, std::size_t)>& change = [](OrbitRecord&, std::size_t) {}) {
    const Model model = load_model("impact-oscillator");
    RunRecord run = testing::run_of(model, "b", "continue");
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
    for (std::size_t number = 0; number < orbits; ++number) {
        OrbitRecord changed = record;
        changed.number = number;
        change(changed, number);
        file.add_orbit("b", changed);
    }
    file.complete_run("b");
}

TEST_F(Hdf5, BranchesHaveOrbitsSegmentsAndMultipliers) {
    const std::string exported = path("all.h5");
    write_branch(path("results.sqlite"));
    export_hdf5(ResultFile(path("results.sqlite"), ResultFile::Access::read), {"b"}, exported);
    EXPECT_EQ(Column(exported, "b/orbits/label").type(), H5T_STRING);
    EXPECT_EQ(Column(exported, "b/orbits/signature").type(), H5T_STRING);
    EXPECT_EQ(Column(exported, "b/orbits/step").type(), H5T_INTEGER);
    EXPECT_EQ(Column(exported, "b/orbits/stable").type(), H5T_INTEGER);
    // A monitor whose name is taken gets another name, and still has real numbers.
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
}

TEST_F(Hdf5, EstimatesHaveUnitsAndCovariances) {
    {
        ResultFile file(path("results.sqlite"), ResultFile::Access::write);
        file.begin_run(testing::run_of(load_model("impact-oscillator"), "found", "identify"));
        file.set_estimates("found",
                           {{{"w0", "rad/s", {95.94, 0.01, 57}, ""}, {"zeta", "", {0.016, 0, 0}, "not determined"}},
                            {1e-4, -2e-9, -2e-9, 4e-8}});
        file.complete_run("found");
    }
    const std::string exported = path("r.h5");
    export_hdf5(ResultFile(path("results.sqlite"), ResultFile::Access::read), {"found"}, exported);
    const auto texts = [&](const std::string& name) { return Column(exported, "found/" + name).texts(); };
    const auto numbers = [&](const std::string& name) { return Column(exported, "found/" + name).numbers(); };
    EXPECT_EQ(texts("estimates/name"), (std::vector<std::string>{"w0", "zeta"}));
    EXPECT_EQ(texts("estimates/unit"), (std::vector<std::string>{"rad/s", ""}));
    EXPECT_EQ(texts("estimates/note"), (std::vector<std::string>{"", "not determined"}));
    EXPECT_EQ(numbers("estimates/value"), (std::vector<double>{95.94, 0.016}));
    EXPECT_EQ(numbers("estimates/error")[0], 0.01);
    EXPECT_EQ(numbers("estimates/freedom")[0], 57);
    EXPECT_TRUE(std::isnan(numbers("estimates/error")[1])) << "it is not known";
    const Estimate known{95.94, 0.01, 57};
    EXPECT_EQ(numbers("estimates/low")[0], 95.94 - known.half_width());
    EXPECT_EQ(numbers("estimates/high")[0], 95.94 + known.half_width());
    EXPECT_EQ(numbers("covariances/position"), (std::vector<double>{0, 0, 1, 1}));
    EXPECT_EQ(numbers("covariances/other"), (std::vector<double>{0, 1, 0, 1}));
    EXPECT_EQ(numbers("covariances/covariance"), (std::vector<double>{1e-4, -2e-9, -2e-9, 4e-8}));
}

TEST_F(Hdf5, ColumnsHaveUnits) {
    const std::string exported = path("all.h5");
    write_branch(path("results.sqlite"));
    export_hdf5(ResultFile(path("results.sqlite"), ResultFile::Access::read), {"b"}, exported);
    EXPECT_EQ(Column(exported, "b/orbits/speed").units(), "m/s");
    EXPECT_EQ(Column(exported, "b/orbits/omega").units(), "none"); // the model has no units
    EXPECT_EQ(Column(exported, "b/orbits/label").units(), "none");
}

TEST_F(Hdf5, TextsArePaddedUnlessOneIsHuge) {
    const std::string exported = path("all.h5"), huge(100'000, 'x');
    const std::vector<std::string> labels{"GR1", "", "SN12", "a"}, parts{"up", "über", "", "up"};
    write_branch(path("results.sqlite"), labels.size(), [&](OrbitRecord& record, std::size_t number) {
        record.label = labels[number];
        record.part = parts[number];
        record.point.detail = number == 2 ? huge : "short";
    });
    export_hdf5(ResultFile(path("results.sqlite"), ResultFile::Access::read), {"b"}, exported);
    const Column label(exported, "b/orbits/label"), part(exported, "b/orbits/part"),
        detail(exported, "b/orbits/detail"), symmetry(exported, "b/orbits/symmetry");
    EXPECT_EQ(label.texts(), labels);
    EXPECT_EQ(label.width(), 4U);
    EXPECT_EQ(label.letters(), H5T_CSET_ASCII);
    EXPECT_EQ(part.texts(), parts);
    EXPECT_EQ(part.width(), 5U); // bytes of UTF-8
    EXPECT_EQ(part.letters(), H5T_CSET_UTF8);
    EXPECT_TRUE(detail.texts() == (std::vector<std::string>{"short", "short", huge, "short"}));
    EXPECT_EQ(detail.width(), 0U);
    EXPECT_EQ(symmetry.texts(), std::vector<std::string>(4)); // all empty
    EXPECT_EQ(symmetry.width(), 1U);
}

/// By default, the library stores in each dataset the second in which it was created.
TEST_F(Hdf5, EqualResultsGiveEqualFiles) {
    write_branch(path("results.sqlite"));
    const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
    const auto bytes = [&](const char* name) {
        export_hdf5(file, {"b"}, path(name));
        return testing::contents(path(name));
    };
    const std::string first = bytes("first.h5");
    usleep(1'100'000);
    EXPECT_TRUE(bytes("second.h5") == first);
}

TEST_F(Hdf5, FilesAreChunkedAndCompressed) {
    const std::string one = path("one.h5"), many = path("many.h5");
    write_branch(path("one.sqlite"));
    export_hdf5(ResultFile(path("one.sqlite"), ResultFile::Access::read), {"b"}, one);
    EXPECT_EQ(Column(one, "b/orbits/omega").chunk(), 0U);
    EXPECT_LT(std::filesystem::file_size(one), 60'000U); // mostly names and headers

    const std::size_t orbits = 9001; // more than fit in one chunk
    write_branch(path("many.sqlite"), orbits, [](OrbitRecord& record, std::size_t number) {
        record.point.monitors = {std::sqrt(static_cast<double>(number)), 0.25};
        record.label = "L" + std::to_string(number);
        record.point.solution.half_multipliers.clear();
    });
    export_hdf5(ResultFile(path("many.sqlite"), ResultFile::Access::read), {"b"}, many);
    const Column root(many, "b/orbits/period_2"), speed(many, "b/orbits/speed"), label(many, "b/orbits/label");
    EXPECT_EQ(root.chunk(), 4501U); // two chunks of nearly the same size
    ASSERT_EQ(root.rows(), orbits);
    const std::vector<double> roots = root.numbers();
    const std::vector<std::string> labels = label.texts();
    for (std::size_t number = 0; number < orbits; ++number) {
        ASSERT_EQ(roots[number], std::sqrt(static_cast<double>(number)));
        ASSERT_EQ(labels[number], "L" + std::to_string(number));
    }
    EXPECT_EQ(speed.numbers(), std::vector<double>(orbits, 0.25));
    EXPECT_LT(speed.stored_bytes(), orbits); // all numbers are equal
    EXPECT_LT(label.stored_bytes(), orbits * label.width());
    EXPECT_EQ(Column(many, "b/half_multipliers/real").rows(), 0U);
    EXPECT_EQ(Column(many, "b/half_multipliers/real").type(), H5T_FLOAT);
}

} // namespace graze::hdf5_test
