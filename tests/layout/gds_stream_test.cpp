#include "graze/layout/gds_stream.hpp"

#include "graze/base/input_error.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace graze::testing::gds_stream_test {

/// Decodes a GDSII number by its definition.
double value_of(std::uint64_t bits) {
    const double fraction = std::ldexp(static_cast<double>(bits & 0x00ffffffffffffffULL), -56);
    const int exponent = static_cast<int>((bits >> 56U) & 0x7fU) - 64;
    return (bits >> 63U ? -1 : 1) * fraction * std::pow(16.0, exponent);
}

TEST(GdsStream, EncodesNumbersByTheFormat) {
    EXPECT_EQ(gds_real(0), 0U);
    EXPECT_EQ(gds_real(1), 0x4110000000000000ULL) << "as in the format's description";
    EXPECT_EQ(gds_real(2), 0x4120000000000000ULL);
    EXPECT_EQ(gds_real(-1), 0xc110000000000000ULL);
    EXPECT_EQ(gds_real(90), 0x425a000000000000ULL);
    EXPECT_EQ(gds_real(1e-3) >> 8U, 0x3e4189374bc6a7ULL);
    EXPECT_EQ(gds_real(1e-9) >> 8U, 0x3944b82fa09b5aULL);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-60, 60);
    for (int i = 0; i < 1000; ++i) {
        const double value = std::pow(10, exponent(random)) * (i % 2 == 0 ? 1 : -1);
        EXPECT_EQ(value_of(gds_real(value)), value) << "56 bits hold all 53";
        EXPECT_GE(gds_real(value) & 0x00f0000000000000ULL, 0x0010000000000000ULL) << "and the first digit is not 0";
    }
}

struct Record {
    int type;
    std::string data;
};

std::vector<Record> records(const std::string& bytes) {
    const auto byte = [&](std::size_t at) { return static_cast<int>(static_cast<unsigned char>(bytes.at(at))); };
    std::vector<Record> result;
    for (std::size_t at = 0; at < bytes.size();) {
        const int length = 256 * byte(at) + byte(at + 1);
        if (length < 4 || length % 2 != 0)
            throw std::runtime_error("a record has no length");
        result.push_back(
            {256 * byte(at + 2) + byte(at + 3), bytes.substr(at + 4, static_cast<std::size_t>(length) - 4)});
        at += static_cast<std::size_t>(length);
    }
    return result;
}

LayoutLibrary small_library() {
    LayoutCell square{.name = "SQUARE", .texts = {{{8, 1}, {5, -6}, "word", 2}}};
    square.add({7, 3}, GridBox{-1, -2, 300, 70'000});
    const LayoutCell top{.name = "TOP", .references = {{"SQUARE", {1000, -1000}, true, 90}, {"SQUARE", {}, false, 0}}};
    return {"odd", {square, top}};
}

TEST(GdsStream, IsTheSequenceOfRecordsOfTheFormat) {
    const std::vector<Record> all = records(gds_stream(small_library()));
    std::vector<int> types;
    for (const Record& one : all)
        types.push_back(one.type);
    EXPECT_EQ(types, (std::vector<int>{0x0002, 0x0102, 0x0206, 0x0305,         //
                                       0x0502, 0x0606,                         //
                                       0x0800, 0x0d02, 0x0e02, 0x1003, 0x1100, // boundary
                                       0x0c00, 0x0d02, 0x1602, 0x1a01, 0x1b05, 0x1003, 0x1906, 0x1100, 0x0700, // text
                                       0x0502, 0x0606,                                                         //
                                       0x0a00, 0x1206, 0x1a01, 0x1c05, 0x1003, 0x1100,                         // turned
                                       0x0a00, 0x1206, 0x1003, 0x1100, 0x0700, 0x0400}));
    EXPECT_EQ(all[0].data, std::string("\x02\x58", 2)) << "version 600";
    EXPECT_EQ(all[2].data, std::string("odd\0", 4)) << "of even length";
    EXPECT_EQ(all[9].data.size(), 40U) << "five corners: the first one again closes it";
    EXPECT_EQ(all[9].data.substr(0, 8), all[9].data.substr(32));
    EXPECT_EQ(all[9].data.substr(0, 8), std::string("\xff\xff\xff\xff\xff\xff\xff\xfe", 8));
    EXPECT_EQ(all[24].data, std::string("\x80\0", 2)) << "mirrored";
    EXPECT_EQ(gds_stream(small_library()), gds_stream(small_library()));
}

TEST(GdsStream, RefusesValuesBeyondTheFormat) {
    LayoutLibrary library = small_library();
    library.cells[0].shapes[0].polygon[0].x = std::int64_t{1} << 31;
    EXPECT_THROW(gds_stream(library), InputError);
    library = small_library();
    library.cells[0].shapes[0].polygon.assign(8191, {});
    EXPECT_THROW(gds_stream(library), InputError);
    library = small_library();
    library.cells[0].name = std::string(33, 'A');
    EXPECT_THROW(gds_stream(library), InputError);
}

/// Sizes beyond GDSII's limits, and cells that contain themselves.
TEST(GdsStream, WrongUsesAreRefused) {
    const GridPolygon square{{0, 0}, {1, 0}, {1, 1}};
    const auto library = [](const LayoutCell& cell) { return LayoutLibrary{"l", {cell}}; };
    LayoutCell cell{.name = "a"};
    cell.add(mask_layers::front, square);
    EXPECT_NO_THROW(gds_stream(library(cell)));
    for (const MaskLayer layer : {MaskLayer{70'000, 0}, MaskLayer{1, 70'000}, MaskLayer{-1, 0}}) {
        LayoutCell wrong = cell;
        wrong.add(layer, square);
        EXPECT_THROW(gds_stream(library(wrong)), InputError);
    }
    for (const GridPolygon& polygon : {GridPolygon{}, GridPolygon{{0, 0}}, GridPolygon{{0, 0}, {1, 0}}}) {
        LayoutCell wrong = cell;
        wrong.add(mask_layers::front, polygon);
        EXPECT_THROW(gds_stream(library(wrong)), InputError);
    }
    for (const CellText& text : {CellText{mask_layers::notes, {0, 0}, std::string(100'000, 'x'), 1},
                                 CellText{mask_layers::notes, {0, 0}, "x", std::nan("")}}) {
        LayoutCell wrong = cell;
        wrong.texts = {text};
        EXPECT_THROW(gds_stream(library(wrong)), InputError);
    }
    for (const std::string& name : {std::string("a"), std::string("missing")}) { // itself; an unknown cell
        LayoutCell wrong = cell;
        wrong.references = {CellReference{name, {0, 0}}};
        EXPECT_THROW(gds_stream(library(wrong)), InputError);
        EXPECT_THROW(flattened(library(wrong), "a"), InputError);
        EXPECT_THROW(areas_of(library(wrong), "a"), InputError);
    }
    LayoutLibrary twice = library(cell);
    twice.cells.push_back(cell);
    EXPECT_THROW(gds_stream(twice), InputError);
}

} // namespace graze::testing::gds_stream_test
