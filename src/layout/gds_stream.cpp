#include "graze/layout/gds_stream.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <limits>

namespace graze {

namespace {

/// Record types, with the data type in the second byte.
enum GdsRecord : int {
    header = 0x0002,
    begin_library = 0x0102,
    library_name = 0x0206,
    units = 0x0305,
    end_library = 0x0400,
    begin_structure = 0x0502,
    structure_name = 0x0606,
    end_structure = 0x0700,
    boundary = 0x0800,
    structure_reference = 0x0a00,
    text = 0x0c00,
    layer_number = 0x0d02,
    data_type = 0x0e02,
    coordinates = 0x1003,
    end_element = 0x1100,
    referred_name = 0x1206,
    text_type = 0x1602,
    string = 0x1906,
    transformation = 0x1a01,
    magnification = 0x1b05,
    angle = 0x1c05,
};

constexpr std::size_t most_corners = 8190, fewest_corners = 3, longest_structure_name = 32, longest_text = 512;
constexpr int largest_layer = 32'767;

class GdsWriter {
public:
    std::string write(const LayoutLibrary& library) {
        constexpr int version = 600;
        constexpr double user_unit = 1e-3, metres = 1e-9; // size of a nanometre in user units and in metres
        shorts(header, {version});
        dates(begin_library);
        if (library.name.size() > longest_text)
            throw InputError(fmt::format("the name of a library has {} letters, which are more than {}",
                                         library.name.size(), longest_text),
                             "shorten it");
        name(library_name, library.name);
        begin(units, 16);
        real(user_unit);
        real(metres);
        for (const LayoutCell& cell : library.cells)
            add(cell);
        require_order_of_cells(library);
        begin(end_library, 0);
        return std::move(bytes_);
    }

private:
    void add(const LayoutCell& cell) {
        if (cell.name.empty() || cell.name.size() > longest_structure_name)
            throw InputError("'" + cell.name + "' cannot be the name of a cell in GDSII", "");
        dates(begin_structure);
        name(structure_name, cell.name);
        for (const CellShape& shape : cell.shapes)
            add(shape);
        for (const CellText& one : cell.texts) {
            require_finite(one.height, "height of a text");
            if (one.text.size() > longest_text)
                throw InputError(fmt::format("a text in cell '{}' has {} letters, which are more than {}", cell.name,
                                             one.text.size(), longest_text),
                                 "shorten it");
            begin(text, 0);
            layer(layer_number, one.layer.layer);
            layer(text_type, one.layer.datatype);
            shorts(transformation, {0});
            begin(magnification, 8);
            real(one.height);
            points({one.at});
            name(string, one.text);
            begin(end_element, 0);
        }
        for (const CellReference& reference : cell.references)
            add(reference);
        begin(end_structure, 0);
    }

    void add(const CellShape& shape) {
        if (shape.polygon.size() > most_corners)
            throw InputError("a polygon has more corners than GDSII can have", "");
        if (shape.polygon.size() < fewest_corners)
            throw InputError(
                fmt::format("a polygon has {} corners instead of {} or more", shape.polygon.size(), fewest_corners),
                "leave out what has no area");
        begin(boundary, 0);
        layer(layer_number, shape.layer.layer);
        layer(data_type, shape.layer.datatype);
        GridPolygon closed = shape.polygon;
        closed.push_back(closed.front());
        points(closed);
        begin(end_element, 0);
    }

    void add(const CellReference& reference) {
        constexpr int mirrored = 0x8000;
        require_finite(reference.degrees, "angle of a cell");
        begin(structure_reference, 0);
        name(referred_name, reference.cell);
        if (reference.mirrored || reference.degrees != 0) {
            shorts(transformation, {reference.mirrored ? mirrored : 0});
            if (reference.degrees != 0) {
                begin(angle, 8);
                real(reference.degrees);
            }
        }
        points({reference.at});
        begin(end_element, 0);
    }

    void layer(GdsRecord record, int number) {
        if (number < 0 || number > largest_layer)
            throw InputError(fmt::format("layer or datatype {} does not fit in GDSII", number),
                             fmt::format("choose one from 0 to {}", largest_layer));
        shorts(record, {number});
    }
    void bits(std::uint64_t value, int count) {
        for (int shift = count - 8; shift >= 0; shift -= 8)
            bytes_ += static_cast<char>(static_cast<unsigned char>(value >> shift));
    }
    void begin(GdsRecord record, std::size_t length) {
        bits(length + 4, 16);
        bits(static_cast<std::uint64_t>(record), 16);
    }
    void shorts(GdsRecord record, std::initializer_list<int> values) {
        begin(record, 2 * values.size());
        for (const int value : values)
            bits(static_cast<std::uint64_t>(value) & 0xffffU, 16);
    }
    void real(double value) { bits(gds_real(value), 64); }
    /// Dates of modification and access: constantly the first of January 2000.
    void dates(GdsRecord record) { shorts(record, {2000, 1, 1, 0, 0, 0, 2000, 1, 1, 0, 0, 0}); }
    /// Writes a name, padded to even length.
    void name(GdsRecord record, const std::string& value) {
        begin(record, value.size() + value.size() % 2);
        bytes_ += value;
        if (value.size() % 2 == 1)
            bytes_ += '\0';
    }
    void points(const GridPolygon& all) {
        begin(coordinates, 8 * all.size());
        for (const GridPoint& point : all)
            for (const std::int64_t value : {point.x, point.y}) {
                if (value < std::numeric_limits<std::int32_t>::min() ||
                    value > std::numeric_limits<std::int32_t>::max())
                    throw InputError("a coordinate does not fit in GDSII", "");
                bits(static_cast<std::uint64_t>(value) & 0xffffffffU, 32);
            }
    }

    std::string bytes_;
};

} // namespace

std::uint64_t gds_real(double value) {
    constexpr int fraction_bits = 56, excess = 64, digit_bits = 4;
    if (value == 0 || !std::isfinite(value))
        return 0;
    int exponent = 0;
    constexpr double largest = 0x1p251, least = 0x1p-256; // slightly below 16^63; 16^-64
    if (std::abs(value) > largest)
        throw InputError(fmt::format("the number {} does not fit in GDSII", value), "");
    if (std::abs(value) < least)
        return 0;
    double fraction = std::frexp(std::abs(value), &exponent);
    while (exponent % digit_bits != 0) { // normalise to a power of 16 and a fraction from 1/16 to 1
        fraction /= 2;
        ++exponent;
    }
    const auto digits = static_cast<std::uint64_t>(std::ldexp(fraction, fraction_bits));
    const int excess_power = exponent / digit_bits + excess;
    const auto power = static_cast<std::uint64_t>(excess_power);
    return (value < 0 ? std::uint64_t{1} << 63U : 0) | (power << static_cast<unsigned>(fraction_bits)) | digits;
}

std::string gds_stream(const LayoutLibrary& library) {
    return GdsWriter().write(library);
}

} // namespace graze
