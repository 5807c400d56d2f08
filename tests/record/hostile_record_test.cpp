// Records that may have been made to attack the reader.

#include "base/temporary_folder.hpp"
#include "graze/base/input_error.hpp"
#include "graze/record/record_file.hpp"
#include "record/hdf5_handle.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <functional>
#include <vector>

namespace graze::testing::hostile_record_test {

using ::testing::HasSubstr;

/// Why a record is refused; empty when it is not.
std::string refusal_of(const std::string& path) {
    try {
        read_all(*open_record(path), 1'000'000);
    } catch (const InputError& error) {
        EXPECT_NE(error.remedy(), "") << error.what();
        return error.what();
    }
    return "";
}

/// An HDF5 file for tests.
void make_file(const std::string& path, const std::function<void(hid_t)>& fill) {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    fill(file);
    H5Fclose(file);
}

/// A dataset of the given numbers, or of zeros.
void add_set(hid_t file, const std::string& name, hsize_t rows, hid_t how = H5P_DEFAULT,
             hid_t type = H5T_NATIVE_DOUBLE) {
    const hid_t space = H5Screate_simple(1, &rows, nullptr);
    const hid_t set = H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    ASSERT_GE(set, 0) << name;
    if (how == H5P_DEFAULT && type == H5T_NATIVE_DOUBLE) {
        std::vector<double> numbers(rows);
        for (std::size_t i = 0; i < numbers.size(); ++i)
            numbers[i] = static_cast<double>(i);
        EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
    }
    H5Dclose(set);
    H5Sclose(space);
}

void add_time(hid_t file, hsize_t rows = 3) {
    add_set(file, "t", rows);
}

/// Creation properties of a dataset.
Hdf5Handle creation() {
    return {H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "", "there are no properties", ""};
}

TEST(HostileRecord, LinksToOtherFilesAreIgnored) {
    const TemporaryFolder folder;
    make_file(folder / "other.h5", [](hid_t file) { add_set(file, "secret", 3); });
    make_file(folder / "r.h5", [&](hid_t file) {
        add_time(file);
        add_set(file, "x", 3);
        H5Lcreate_external((folder / "other.h5").c_str(), "/secret", file, "y", H5P_DEFAULT, H5P_DEFAULT);
        H5Lcreate_soft("/x", file, "z", H5P_DEFAULT, H5P_DEFAULT);
    });
    const auto record = open_record(folder / "r.h5");
    ASSERT_EQ(record->header().channels.size(), 1U);
    EXPECT_EQ(record->header().channels[0].name, "x");
}

TEST(HostileRecord, DataInOtherFilesAreNotRead) {
    const TemporaryFolder folder;
    const std::string secret = folder.write("secret", std::string(24, 'x'));
    make_file(folder / "external.h5", [&](hid_t file) {
        const Hdf5Handle elsewhere = creation();
        H5Pset_external(elsewhere.id(), secret.c_str(), 0, 24);
        add_time(file);
        add_set(file, "x", 3, elsewhere.id());
    });
    EXPECT_THAT(refusal_of(folder / "external.h5"), HasSubstr("it is kept in another file"));
    make_file(folder / "other.h5", [](hid_t file) { add_set(file, "secret", 3); });
    make_file(folder / "virtual.h5", [&](hid_t file) {
        const Hdf5Handle elsewhere = creation();
        const hsize_t rows = 3;
        const hid_t space = H5Screate_simple(1, &rows, nullptr);
        H5Pset_virtual(elsewhere.id(), space, (folder / "other.h5").c_str(), "/secret", space);
        H5Sclose(space);
        add_time(file);
        add_set(file, "x", 3, elsewhere.id());
    });
    EXPECT_THAT(refusal_of(folder / "virtual.h5"), HasSubstr("it is kept in another file"));
}

/// For a filter with an unknown number HDF5 would search for plug-ins.
TEST(HostileRecord, PluginFiltersAreNotLoaded) {
    const TemporaryFolder folder;
    const H5Z_class2_t foreign{
        H5Z_CLASS_T_VERS,
        333,
        1,
        1,
        "foreign",
        nullptr,
        nullptr,
        [](unsigned, std::size_t, const unsigned*, std::size_t size, std::size_t*, void**) { return size; }};
    ASSERT_GE(H5Zregister(&foreign), 0);
    make_file(folder / "r.h5", [](hid_t file) {
        const Hdf5Handle filtered = creation();
        const hsize_t chunk = 3;
        H5Pset_chunk(filtered.id(), 1, &chunk);
        H5Pset_filter(filtered.id(), 333, 0, 0, nullptr);
        add_time(file);
        add_set(file, "x", 3, filtered.id());
        const double numbers[] = {1, 2, 3};
        const hid_t set = H5Dopen2(file, "x", H5P_DEFAULT);
        EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers), 0);
        H5Dclose(set);
    });
    H5Zunregister(333);
    EXPECT_THAT(refusal_of(folder / "r.h5"), HasSubstr("it cannot be read"));
}

TEST(HostileRecord, SizesOfChunksAndGroupsAreLimited) {
    const TemporaryFolder folder;
    const auto with_chunk = [&](hsize_t chunk) {
        make_file(folder / "chunk.h5", [chunk](hid_t file) {
            const Hdf5Handle chunked = creation();
            H5Pset_chunk(chunked.id(), 1, &chunk);
            H5Pset_deflate(chunked.id(), 1);
            add_time(file);
            const hsize_t rows = 3, most = H5S_UNLIMITED;
            const hid_t space = H5Screate_simple(1, &rows, &most);
            H5Dclose(H5Dcreate2(file, "x", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, chunked.id(), H5P_DEFAULT));
            H5Sclose(space);
        });
        return refusal_of(folder / "chunk.h5");
    };
    EXPECT_EQ(with_chunk(hsize_t{1} << 20), "");
    EXPECT_THAT(with_chunk((hsize_t{64} << 17) + 1), HasSubstr("its chunks are too large")); // 8 bytes more than 64 MiB
    for (const int members : {1000, 1001}) {
        make_file(folder / "group.h5", [members](hid_t file) {
            add_time(file);
            add_set(file, "x", 3);
            for (int i = 2; i < members; ++i)
                H5Lcreate_hard(file, "/x", file, ("x" + std::to_string(i)).c_str(), H5P_DEFAULT, H5P_DEFAULT);
        });
        const std::string refusal = refusal_of(folder / "group.h5");
        EXPECT_TRUE(members == 1000 ? refusal.empty() : refusal.find("more than 1000") != std::string::npos) << refusal;
    }
}

TEST(HostileRecord, OnlyDatasetsOfNumbersAreChannels) {
    const TemporaryFolder folder;
    make_file(folder / "r.h5", [](hid_t file) {
        add_time(file);
        add_set(file, "x", 3);
        add_set(file, "words", 3, H5P_DEFAULT, H5T_C_S1);
        H5Gclose(H5Gcreate2(file, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    });
    EXPECT_EQ(open_record(folder / "r.h5")->header().channels.size(), 1U);
}

TEST(HostileRecord, LengthsOfLinesAndNumbersOfColumnsAreLimited) {
    const TemporaryFolder folder;
    const std::string head = "t,x\n0,1\n", blanks(1 << 20, ' ');
    EXPECT_EQ(refusal_of(folder.write("long.csv", head + "1,2" + blanks.substr(3) + "\n")), "");
    EXPECT_THAT(refusal_of(folder.write("long.csv", head + "1,2" + blanks + "\n")),
                HasSubstr("more than 1048576 bytes"));
    EXPECT_THAT(refusal_of(folder.write("endless.csv", head + std::string(8 << 20, '1'))),
                HasSubstr("more than 1048576"));
    for (const int columns : {10'000, 10'002}) {
        std::string text = "t", row = "\n0";
        for (int i = 1; i < columns; ++i) {
            text += ",c" + std::to_string(i);
            row += ",1";
        }
        const std::string refusal = refusal_of(folder.write("wide.csv", text + row + "\n"));
        EXPECT_TRUE(columns == 10'000 ? refusal.empty() : refusal.find("more than 10000 columns") != std::string::npos)
            << refusal;
    }
}

TEST(HostileRecord, TextHasNoGroups) {
    const TemporaryFolder folder;
    EXPECT_THROW(open_record(folder.write("r.csv", "t,x\n0,1\n"), {.group = "/g"}), InputError);
}

TEST(HostileRecord, PipesAndDevicesAreRefused) {
    const TemporaryFolder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const std::string& path : {pipe, std::string("/dev/zero"), std::string("/dev/null"), folder.path()})
        EXPECT_THAT(refusal_of(path), HasSubstr("not a record"));
}

} // namespace graze::testing::hostile_record_test
