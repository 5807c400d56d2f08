// Wrong uses of designs, drawings and tables.

#include "misuse/wrong_use.hpp"

#include "graze/design/wishes.hpp"
#include "graze/layout/folded_spring.hpp"
#include "graze/layout/gds_stream.hpp"
#include "graze/layout/layout.hpp"
#include "graze/layout/plate_attraction.hpp"
#include "graze/layout/squeeze_film.hpp"
#include "graze/results/table.hpp"

#include <limits>

namespace graze::layout_misuse_test {

using namespace graze::testing;

GridPolygon triangle() {
    return {{0, 0}, {1000, 0}, {0, 1000}};
}

/// Two cells, the second of which contains the first.
LayoutLibrary library() {
    LayoutLibrary two{"library", {{"inner", {}, {}, {}}, {"outer", {}, {}, {}}}};
    two.cells[0].add({1, 0}, triangle());
    two.cells[0].texts.push_back({{20, 1}, {0, 0}, "note", 10});
    two.cells[1].references.push_back({"inner", {500, 500}, false, 90});
    return two;
}

void drawings(WrongUses& wrong) {
    const auto stream = wrong.spoiled<LayoutLibrary>(library, {{"gds", [](LayoutLibrary& l) { keep(gds_stream(l)); }}});
    const auto all =
        wrong.spoiled<LayoutLibrary>(library, {{"gds", [](LayoutLibrary& l) { keep(gds_stream(l)); }},
                                               {"flattened", [](LayoutLibrary& l) { keep(flattened(l, "outer")); }},
                                               {"areas", [](LayoutLibrary& l) { keep(areas_of(l, "outer")); }}});
    all("cell_missing", [](LayoutLibrary& l) { l.cells[1].references[0].cell = "nothing"; });
    all("cell_after", [](LayoutLibrary& l) { std::swap(l.cells[0], l.cells[1]); });
    all("cell_in_itself", [](LayoutLibrary& l) { l.cells[1].references[0].cell = "outer"; });
    all("cells_in_a_circle", [](LayoutLibrary& l) { l.cells[0].references.push_back({"outer", {}, false, 0}); });
    all("cell_twice", [](LayoutLibrary& l) { l.cells[0].name = "outer"; });
    stream("cell_without_name", [](LayoutLibrary& l) { l.cells[1].name.clear(); });
    stream("cell_name_long", [](LayoutLibrary& l) { l.cells[1].name = std::string(33, 'a'); });
    stream("library_name_long", [](LayoutLibrary& l) { l.name = std::string(70'000, 'a'); });
    for (const std::size_t corners : {0, 1, 2, 8191})
        stream("corners_" + std::to_string(corners),
               [corners](LayoutLibrary& l) { l.cells[0].shapes[0].polygon.resize(corners); });
    for (const int number : {-1, 32'768, 70'000, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
        stream("layer_" + std::to_string(number),
               [number](LayoutLibrary& l) { l.cells[0].shapes[0].layer.layer = number; });
        stream("datatype_" + std::to_string(number),
               [number](LayoutLibrary& l) { l.cells[0].shapes[0].layer.datatype = number; });
        stream("text_layer_" + std::to_string(number),
               [number](LayoutLibrary& l) { l.cells[0].texts[0].layer.layer = number; });
    }
    for (const std::size_t letters : {513, 70'000})
        stream("text_" + std::to_string(letters),
               [letters](LayoutLibrary& l) { l.cells[0].texts[0].text.assign(letters, 'a'); });
    for (const std::int64_t far :
         {std::int64_t{1} << 31, -(std::int64_t{1} << 31) - 1, std::numeric_limits<std::int64_t>::max()}) {
        stream("corner_" + std::to_string(far), [far](LayoutLibrary& l) { l.cells[0].shapes[0].polygon[1].x = far; });
        stream("text_at_" + std::to_string(far), [far](LayoutLibrary& l) { l.cells[0].texts[0].at.y = far; });
        stream("reference_at_" + std::to_string(far), [far](LayoutLibrary& l) { l.cells[1].references[0].at.x = far; });
    }
    stream("text_height", not_finite(), [](LayoutLibrary& l, double value) { l.cells[0].texts[0].height = value; });
    stream("angle", not_finite(), [](LayoutLibrary& l, double value) { l.cells[1].references[0].degrees = value; });
    stream("text_height_too_large", [](LayoutLibrary& l) { l.cells[0].texts[0].height = 1e100; });
    stream("angle_too_large", [](LayoutLibrary& l) { l.cells[1].references[0].degrees = -1e100; });
    wrong("flattened_unknown", [] { keep(flattened(library(), "nothing")); });
    wrong("areas_unknown", [] { keep(areas_of(library(), "nothing")); });
}

void parts(WrongUses& wrong) {
    const Gas air{101'325, 1.8e-5, 6.8e-8};
    wrong("capacitance_height", not_positive(), [](double value) { keep(capacitance_by_length(value, 1e-6, 1e-6)); });
    wrong("capacitance_gap", not_positive(), [](double value) { keep(capacitance_by_length(1e-6, value, 1e-6)); });
    wrong("plates_length", not_positive(), [](double value) {
        keep(equivalent_plates({value, 1e-5, 1e-5, {1e-6, 1e-6}}));
    });
    wrong("plates_gap", not_positive(), [](double value) {
        keep(equivalent_plates({1e-4, 1e-5, 1e-5, {1e-6, value}}));
    });
    wrong("plates_gap_top", not_positive(), [](double value) {
        keep(equivalent_plates({1e-4, 1e-5, 1e-5, {value, 1e-6}}));
    });
    wrong("film_length", not_positive(), [air](double value) {
        keep(squeeze_film_damping({value, 1e-5, {1e-6, 1e-6}}, air));
    });
    wrong("film_gap", not_positive(), [air](double value) {
        keep(squeeze_film_damping({1e-4, 1e-5, {value, 1e-6}}, air));
    });
    wrong("film_gap_bottom", not_positive(), [air](double value) {
        keep(squeeze_film_damping({1e-4, 1e-5, {1e-6, value}}, air));
    });
    wrong("viscosity_gap", not_positive(), [air](double value) { keep(effective_viscosity(air, value)); });
    wrong("viscosity_pressure", not_positive(), [](double value) {
        keep(effective_viscosity({value, 1.8e-5, 6.8e-8}, 1e-6));
    });
    wrong("spring_of_nothing", [] { keep(properties_of(FoldedSpring())); });
    for (const int mask : {0, 3, -1})
        wrong("mask_" + std::to_string(mask),
              [mask] { keep(mask_library(draw_device_layout(load_device_file("mems-switch-device")), mask)); });
    wrong("device_file_unknown", [] { keep(load_device_file("nothing-there")); });
}

void designs(WrongUses& wrong) {
    static const Design design = load_design("mems-switch");
    const std::size_t count = design.dimensions.size();
    wrong("with_values", wrong_lengths(count),
          [](std::size_t length) { keep(with_values(design, std::vector<double>(length, 1))); });
    wrong("with_values", not_finite(), [count](double value) {
        std::vector<double> values(count, 1);
        values.back() = value;
        keep(with_values(design, values));
    });
    wrong("design_unknown", [] { keep(load_design("nothing-there")); });
}

/// A table with two rows of a number and a text.
Table table() {
    Table two({{"number", "m"}, {"text", ""}});
    for (const char* text : {"a", "b"}) {
        two.add(1.5);
        two.add(text);
    }
    return two;
}

void tables(WrongUses& wrong) {
    wrong("table_number_row", wrong_indices(2), [](std::size_t index) { keep(table().number(index, 0)); });
    wrong("table_number_column", wrong_indices(2), [](std::size_t index) { keep(table().number(0, index)); });
    wrong("table_text_row", wrong_indices(2), [](std::size_t index) { keep(std::string(table().text(index, 1))); });
    wrong("table_text_column", wrong_indices(2), [](std::size_t index) { keep(std::string(table().text(0, index))); });
    wrong("table_is_text_row", wrong_indices(2), [](std::size_t index) { keep(table().is_text(index, 0)); });
    wrong("table_is_missing_column", wrong_indices(2), [](std::size_t index) { keep(table().is_missing(0, index)); });
    wrong("table_text_of_number", [] { keep(std::string(table().text(0, 0))); });
    wrong("table_of_no_columns", [] { keep(Table().number(0, 0)); });
}

TEST(WrongLayoutUse, IsRefused) {
    expect_refusals({drawings, parts, designs, tables});
}

/// A copy of a table owns its texts.
TEST(WrongLayoutUse, TablesOutliveTheirSource) {
    Table copy;
    {
        const Table first = table();
        copy = first;
    }
    EXPECT_EQ(copy.text(1, 1), "b");
}

} // namespace graze::layout_misuse_test
