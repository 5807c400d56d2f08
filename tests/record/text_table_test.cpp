#include "record/text_table.hpp"

#include "base/temporary_folder.hpp"
#include "graze/base/input_error.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <tuple>

namespace graze::testing::text_table_test {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t most = 1'000'000;

/// A file that was read, with its remarks.
struct ReadFile {
    RecordHeader header;
    Samples rows;
    std::vector<std::string> remarks;

    std::vector<std::string> names() const {
        std::vector<std::string> result{header.time.name + "|" + header.time.unit};
        for (const Channel& channel : header.channels)
            result.push_back(channel.name + "|" + channel.unit);
        return result;
    }
};

ReadFile read_file(const std::string& text, RecordLayout layout = {}) {
    const TemporaryFolder folder;
    ReadFile result;
    layout.remark = [&](const std::string& remark) { result.remarks.push_back(remark); };
    const auto record = open_record(folder.write("r.csv", text), layout);
    result.header = record->header();
    result.rows = read_all(*record, most);
    return result;
}

std::string refusal_of(const std::string& text, const RecordLayout& layout = {}) {
    try {
        read_file(text, layout);
    } catch (const InputError& error) {
        EXPECT_NE(error.remedy(), "") << error.what();
        return error.what();
    }
    return "nothing";
}

const std::string labview_heading =
    "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
    "Decimal_Separator\t.\nMulti_Headings\tYes\nX_Columns\tOne\nTime_Pref\tAbsolute\n"
    "Operator\tNobody\nDate\t2019/05/14\nTime\t10:22:31.123\n***End_of_Header***\t\n\t\n";
const std::string labview_segment =
    "Channels\t2\t\t\nSamples\t3\t3\t\nDate\t2019/05/14\t2019/05/14\t\nTime\t10:22:31\t10:22:31\t\n"
    "Y_Unit_Label\tVolts\tAmps\t\nX_Dimension\tTime\tTime\t\nX0\t0.5\t0.5\t\nDelta_X\t0.001\t0.001\t\n"
    "***End_of_Header***\t\t\t\nX_Value\tVoltage\tCurrent\tComment\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

TEST(TextTable, ReadsMeasurementFilesOfLabview) {
    const ReadFile one =
        read_file(labview_heading + labview_segment + "0.500\t1.25\t-2\ta remark\n0.501\t1.5\t-3\n0.502\t1.75\t-4\t\n");
    EXPECT_THAT(one.names(), ElementsAre("X_Value|s", "Voltage|V", "Current|A"));
    EXPECT_THAT(one.rows.times, ElementsAre(0.5, 0.501, 0.502));
    EXPECT_THAT(one.rows.values[0], ElementsAre(1.25, 1.5, 1.75));
    EXPECT_THAT(one.rows.values[1], ElementsAre(-2, -3, -4));
    EXPECT_TRUE(one.remarks.empty());
}

TEST(TextTable, ReadsLabviewWithoutTimesInRows) {
    const std::string heading = replaced(labview_heading, "X_Columns\tOne", "X_Columns\tNo");
    const ReadFile no = read_file(heading + labview_segment + "\t1.25\t-2\n\t1.5\t-3\n\t1.75\t-4\n");
    EXPECT_THAT(no.names(), ElementsAre("X_Value|s", "Voltage|V", "Current|A"));
    EXPECT_THAT(no.rows.times, ElementsAre(0.5, 0.501, 0.502));
    EXPECT_THAT(no.rows.values[1], ElementsAre(-2, -3, -4));
    EXPECT_THAT(refusal_of(heading + replaced(labview_segment, "X0\t0.5\t0.5", "X0\t0.5\t0.6") + "\t1\t2\n"),
                HasSubstr("the channels have no common X0"));
}

TEST(TextTable, ReadsLabviewWithDecimalCommas) {
    const std::string heading = replaced(replaced(labview_heading, "Decimal_Separator\t.", "Decimal_Separator\t,"),
                                         "X_Columns\tOne", "X_Columns\tNo");
    const ReadFile file =
        read_file(heading + replaced(replaced(labview_segment, "0.5", "0,5"), "0.001", "0,001") + "\t1,25\t-2,0\n");
    EXPECT_THAT(file.rows.times, ElementsAre(0.5));
    EXPECT_THAT(file.rows.values[0], ElementsAre(1.25));
}

TEST(TextTable, RefusesLabviewWithSeveralTables) {
    EXPECT_THAT(
        refusal_of(replaced(labview_heading, "X_Columns\tOne", "X_Columns\tMulti") + labview_segment + "0\t1\t0\t2\n"),
        HasSubstr("each channel has times of its own"));
    EXPECT_THAT(refusal_of(labview_heading + labview_segment + "0\t1\t2\n1\t1\t2\n\n" + labview_segment + "2\t1\t2\n"),
                HasSubstr("another heading begins here"));
    EXPECT_THAT(refusal_of(labview_heading), HasSubstr("has no end"));
}

TEST(TextTable, ReadsTektronixWithTheHeadingBesideTheRows) {
    const ReadFile file = read_file("Record Length,2.500000e+03,,-0.00050000,0.00240,\r\n"
                                    "Sample Interval,4.000000e-07,,-0.00049960,0.00250,\r\n"
                                    "Trigger Point,1.25e+03,,-0.00049920,0.00260,\r\n"
                                    "Source,CH2,,-0.00049880,0.00270,\r\nVertical Units,V,,-0.00049840,0.00280,\r\n"
                                    "Horizontal Units,s,,-0.00049800,0.00290,\r\n,,,-0.00049760,0.00300,\r\n");
    EXPECT_THAT(file.names(), ElementsAre("t|s", "CH2|V"));
    ASSERT_EQ(file.rows.rows(), 7U);
    EXPECT_EQ(file.rows.times[0], -0.0005);
    EXPECT_EQ(file.rows.times[6], -0.0004976);
    EXPECT_EQ(file.rows.values[0][6], 0.003);
}

TEST(TextTable, ReadsTektronixWithTheHeadingAboveTheRows) {
    const ReadFile file = read_file("Model,MSO2024B\nFirmware Version,1.52\n,\nPoint Format,Y,\nHorizontal Units,s,\n"
                                    "Horizontal Scale,4e-06,\nSample Interval,4e-08,\nRecord Length,100000,\n"
                                    "Gating,0.0% to 100.0%,\nProbe Attenuation,1,1\nVertical Units,V,A\nLabel,,\n"
                                    "TIME,CH1,CH2\n-2.0e-05,0.125,1\n-1.9e-05,0.25,2\n");
    EXPECT_THAT(file.names(), ElementsAre("TIME|s", "CH1|V", "CH2|A"));
    EXPECT_THAT(file.rows.times, ElementsAre(-2e-5, -1.9e-5));
    EXPECT_THAT(file.rows.values[1], ElementsAre(1, 2));
}

TEST(TextTable, ReadsKeysight) {
    const ReadFile file = read_file("x-axis,1,2\nsecond,Volt,Ampere\n-4.9E-04,+1.5E-01,2\n-4.8E-04,+9.9E+37,2\n"
                                    "-4.7E-04,1.7E-01,3\n");
    EXPECT_THAT(file.names(), ElementsAre("x-axis|s", "CH1|V", "CH2|A"));
    EXPECT_THAT(file.rows.times, ElementsAre(-4.9e-4, -4.7e-4));
    EXPECT_THAT(file.rows.values[0], ElementsAre(0.15, 0.17));
    ASSERT_EQ(file.remarks.size(), 1U);
    EXPECT_THAT(file.remarks[0], HasSubstr("1 of 3 rows are left out, as a value is missing (the first in line 4)"));
}

TEST(TextTable, ReadsLecroy) {
    const ReadFile file = read_file("LECROYWR64Xi,12345,Waveform\nSegments,1,SegmentSize,3\n"
                                    "Segment,TrigTime,TimeSinceSegment1\n#1,14-May-2019 10:22:31,0\nTime,Ampl\n"
                                    "-5e-06,0.0123\n-4.9e-06,0.0125\n");
    EXPECT_THAT(file.names(), ElementsAre("Time|s", "Ampl|"));
    EXPECT_THAT(file.rows.times, ElementsAre(-5e-6, -4.9e-6));
    EXPECT_THAT(file.rows.values[0], ElementsAre(0.0123, 0.0125));
}

TEST(TextTable, ReadsRigol) {
    const ReadFile counted = read_file("X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-6.000000e-03,1.000000e-05\n"
                                       "0,1.20e+00,4.0e-01,\n1,1.30e+00,5.0e-01,\n2,1.40e+00,6.0e-01,\n");
    EXPECT_THAT(counted.names(), ElementsAre("t|s", "CH1|V", "CH2|V"));
    EXPECT_EQ(counted.rows.times[0], -6e-3);
    EXPECT_NEAR(counted.rows.times[2], -6e-3 + 2e-5, 1e-17);
    EXPECT_THAT(counted.rows.values[1], ElementsAre(0.4, 0.5, 0.6));
    const ReadFile timed = read_file("X,CH1,\nSecond,Volt,\n-3.0e-03,1.2,\n-2.9e-03,1.3,\n");
    EXPECT_THAT(timed.names(), ElementsAre("X|s", "CH1|V"));
    EXPECT_THAT(timed.rows.times, ElementsAre(-3e-3, -2.9e-3));
    const ReadFile named = read_file("CH1V,CH2V,t0 =-5.0e-04s, tInc = 1.0e-06,\n0.25,1,,\n0.50,2,,\n");
    EXPECT_THAT(named.names(), ElementsAre("t|s", "CH1|V", "CH2|V"));
    EXPECT_NEAR(named.rows.times[1], -4.99e-4, 1e-18);
    EXPECT_THAT(named.rows.values[1], ElementsAre(1, 2));
    EXPECT_THAT(read_file("CH1V,t0 =0s, tInc = 0.5,\n0.25,,\n0.50,,\n").rows.times, ElementsAre(0, 0.5));
}

/// Times in headings have units: a start of -30 ms is -0.03 s.
TEST(TextTable, TimesInHeadingsHaveUnits) {
    for (const char* times : {"t0 =-30ms, tInc = 1ms", "t0 =-0.03s, tInc = 1000us", "t0 =-3e-2, tInc = 1e6 ns"}) {
        const ReadFile file = read_file("CH1V,CH2mV," + std::string(times) + ",\n0.1,1,,\n0.2,2,,\n0.1,3,,\n");
        EXPECT_THAT(file.names(), ElementsAre("t|s", "CH1|V", "CH2|mV"));
        EXPECT_THAT(file.rows.times, ElementsAre(-0.03, DoubleEq(-0.029), DoubleEq(-0.028))) << times;
    }
    const ReadFile counted = read_file("X,CH1,Start,Increment,\nSequence,Volt,-30ms,1ms\n0,0.1,\n1,0.2,\n2,0.1,\n");
    EXPECT_THAT(counted.rows.times, ElementsAre(-0.03, DoubleEq(-0.029), DoubleEq(-0.028)));
    EXPECT_THAT(refusal_of("CH1V,t0 =-30V, tInc = 1ms,\n0.1,,\n0.2,,\n"), HasSubstr("'-30V' is not a time"));

    const std::string heading = replaced(labview_heading, "X_Columns\tOne", "X_Columns\tNo");
    for (const char* unit : {"ms", "\"ms\""}) {
        const std::string segment =
            replaced(labview_segment, "X0\t", "X_Unit_Label\t" + std::string(unit) + "\t" + unit + "\t\nX0\t");
        const ReadFile file = read_file(heading + segment + "\t1.25\t-2\n\t1.5\t-3\n");
        EXPECT_THAT(file.names(), ElementsAre("X_Value|ms", "Voltage|V", "Current|A"));
        EXPECT_THAT(file.rows.times, ElementsAre(0.5, 0.501));
        EXPECT_EQ(read_file(labview_heading + segment + "0.5\t1\t2\n").header.time.unit, "ms");
    }
    EXPECT_THAT(refusal_of(heading + replaced(labview_segment, "X0\t", "X_Unit_Label\ts\tms\t\nX0\t") + "\t1\t2\n"),
                HasSubstr("the channels have no common X_Unit_Label"));
}

TEST(TextTable, UnitsAreUnderstoodInManySpellings) {
    const std::string rows = "\n0,1\n1,2\n";
    for (const auto& [heading, time, channel] :
         {std::tuple{"t [msec], v [Volts]", "t|ms", "v|V"},
          std::tuple{"\"Time, s\",\"Velocity, V\"", "Time|s", "Velocity|V"},
          std::tuple{"t / s, v / (m/s)", "t|s", "v|m/s"}, std::tuple{"in s,CH1 in V", "in s|", "CH1|V"},
          std::tuple{"\"t [min]\",\"v, left [mV]\"", "t|min", "v, left|mV"},
          std::tuple{"x-axis,1\nmSec,Volt", "x-axis|ms", "CH1|V"},
          std::tuple{"Horizontal Units,S\nVertical Units,V\nTIME,CH1", "TIME|s", "CH1|V"},
          std::tuple{"t,5\" plate", "t|", "5\" plate|"}})
        EXPECT_THAT(read_file(heading + rows).names(), ElementsAre(time, channel)) << heading;
    EXPECT_THAT(refusal_of("t [mS], v [V]" + rows), HasSubstr("the unit of the times, mS, is one of conductance"));
    EXPECT_THAT(read_file("t [ms], g [mS]" + rows).names(), ElementsAre("t|ms", "g|mS"));
}

TEST(TextTable, RemedyNamesACommentThatMayNameColumns) {
    EXPECT_THAT(refusal_of("# made by hand\n# t [s], v [V]\n0,1\n1,2\n"),
                HasSubstr("or name them; if the comment in line 2 does, name that line"));
    EXPECT_THAT(refusal_of("# made by hand\n0,1\n1,2\n"), Not(HasSubstr("names-line")));
}

TEST(TextTable, ReadsDecimalCommas) {
    for (const char* text : {"t [s];v [V]\n0,5;-1,25e0\n1;2\n", "t [s]\tv [V]\n0,5\t-1,25\n1\t2\n",
                             "Zeit [s] v [V]\n0,5 -1,25\n1,0 2,0\n", "Zeit (s), Uhr\tv\n0,5\t-1,25\n1,0\t2,0\n"}) {
        const ReadFile file = read_file(text);
        EXPECT_THAT(file.rows.times, ElementsAre(0.5, 1)) << text;
        EXPECT_THAT(file.rows.values[0], ElementsAre(-1.25, 2)) << text;
    }
    const RecordLayout layout{.columns = "t [s], v [V]"};
    EXPECT_THAT(read_file("0,5;-1,25\n1,0;2,0\n", layout).rows.values[0], ElementsAre(-1.25, 2));
    EXPECT_THAT(read_file("0,5 -1,25\n1,0 2,0\n", layout).rows.values[0], ElementsAre(-1.25, 2));
    // With both signs in use neither is certain.
    EXPECT_THAT(refusal_of("t;v\n0,5;1\n1.5;2\n"), HasSubstr("r.csv:3:"));
    EXPECT_THAT(refusal_of("t;v\n0.5;1\n1,5;2\n"), HasSubstr("has a comma, and numbers before it have decimal points"));
    EXPECT_THAT(refusal_of("t;v\n0,5;1.234,5\n"), HasSubstr("r.csv:2:"));
}

TEST(TextTable, MissingValuesAreLeftOutAndCounted) {
    const ReadFile file =
        read_file("t [s],v [V],w\n0,1,2\n1,,2\n2,nan,3\n3,1,-inf\n4,4,5\n5,6,\n6,---,1\n7,1.#QNAN,1\n");
    EXPECT_THAT(file.rows.times, ElementsAre(0, 4));
    EXPECT_THAT(file.rows.values[1], ElementsAre(2, 5));
    ASSERT_EQ(file.remarks.size(), 1U);
    EXPECT_THAT(file.remarks[0], HasSubstr("6 of 8 rows are left out, as a value is missing (the first in line 3)"));
    EXPECT_THAT(read_file("t\tv\tw\n0\t\t2\n1\t1\t2\n").rows.times, ElementsAre(1));
    EXPECT_THAT(refusal_of("t,v\n0,1\n1,x\n"), HasSubstr("r.csv:3:3: 'x' is not a finite number"));
}

/// Rows that begin with missing values are not names.
TEST(TextTable, FirstRowsMayMissValues) {
    for (const char* missing : {"", "nan", "9.9E37", "---", "OVLD", "\u221e", "-\u221e"}) {
        const std::string none(missing);
        const ReadFile named = read_file("t [s],v [V]\n0," + none + "\n1," + none + "\n2,3\n3,4\n");
        EXPECT_THAT(named.names(), ElementsAre("t|s", "v|V")) << none;
        EXPECT_THAT(named.rows.times, ElementsAre(2, 3)) << none;
        ASSERT_EQ(named.remarks.size(), 1U);
        EXPECT_THAT(named.remarks[0],
                    HasSubstr("2 of 4 rows are left out, as a value is missing (the first in line 2)"));
        EXPECT_THAT(read_file("Logger 5\n\nTime;Force\ns;N\n0;" + none + "\n1;2\n").names(),
                    ElementsAre("Time|s", "Force|N"));
        if (!none.empty()) {
            const std::string row = "0," + none + "," + none + "," + none + "," + none + "\n";
            EXPECT_THAT(read_file(row + "1,2,3,4,5\n").rows.times, ElementsAre(1)) << none;
        }
    }
}

TEST(TextTable, SaysWhyAFieldIsNotANumber) {
    EXPECT_THAT(refusal_of("t [s],v [V]\n12:00:00.001,1\n12:00:00.002,2\n"),
                HasSubstr("r.csv:2:1: '12:00:00.001' is a time of day or a date; write times as numbers"));
    EXPECT_THAT(refusal_of("t;v\n2020-05-14;1\n"), HasSubstr("is a time of day or a date"));
    EXPECT_THAT(refusal_of("t,v\n0,\"0.1\"\n"), HasSubstr("r.csv:2:3: '\"0.1\"' is in quotes"));
    EXPECT_THAT(refusal_of("t,v\n0,1\n1,2\nend of data,3\n"), Not(HasSubstr("--skip")));
    EXPECT_THAT(refusal_of("t [\xb5s],v [V]\n0,1\n1,2\n"),
                HasSubstr("r.csv:1:4: 't [\xef\xbf\xbds]' is not text in UTF-8"));
}

/// A file may end anywhere: no truncated number is taken for another.
TEST(TextTable, TruncatedRowsAreLeftOut) {
    const std::string whole = "t,v\n0,1.25\n1,2.375\n2,3.4375\n";
    for (std::size_t size = 5; size <= whole.size(); ++size) {
        ReadFile file;
        try {
            file = read_file(whole.substr(0, size));
        } catch (const InputError&) {
            continue;
        }
        for (std::size_t i = 0; i < file.rows.rows(); ++i)
            EXPECT_EQ(file.rows.values[0][i], (std::vector{1.25, 2.375, 3.4375})[i]) << size;
        const std::string text = whole.substr(0, size);
        EXPECT_EQ(file.rows.rows() + 1, static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'))) << size;
        EXPECT_EQ(file.remarks.size(), text.back() == '\n' ? 0U : 1U) << size;
    }
    const ReadFile cut = read_file("t,v\r\n0,1\r\n1,2.3");
    EXPECT_THAT(cut.rows.times, ElementsAre(0));
    ASSERT_EQ(cut.remarks.size(), 1U);
    EXPECT_THAT(cut.remarks[0], HasSubstr("line 3, the last one, has no end and may have been cut off"));
    EXPECT_THAT(read_file("t,v\r\n0,1\r\n1,2\r").rows.times, ElementsAre(0, 1)); // cut within the line end
}

TEST(TextTable, TakesLinesThatTheLayoutNames) {
    const std::string text = "made by somebody, at 12:03\n1,2\n% t [s], a, b\n(s),(V),(A)\n\n0,1,2\n1,3,4\n";
    const ReadFile file = read_file(text, {.names_line = 3, .units_line = 4});
    EXPECT_THAT(file.names(), ElementsAre("t|s", "a|V", "b|A"));
    EXPECT_THAT(file.rows.values[1], ElementsAre(2, 4));
    EXPECT_THAT(read_file(text, {.columns = "t [ms], x, y", .skip = 4}).names(), ElementsAre("t|ms", "x|", "y|"));
    EXPECT_THAT(read_file("1,2\nt,v\n0,1\n", {.skip = 1}).rows.times, ElementsAre(0));
    EXPECT_THAT(refusal_of(text, {.skip = 100}), HasSubstr("the file has 7 lines"));
    EXPECT_THAT(refusal_of("made by\nsomebody\nt,v\n0,1,2\n"),
                HasSubstr("r.csv:4:1: this row has 3 columns, and line 3, which should name them, has 2"));
}

TEST(TextTable, SkipsLinesAboveTheNames) {
    const ReadFile file = read_file("Logger 5\nstarted;12.3.2020\nRate;1000\n\nTime;Force;\ns;N;\n0;1;\n0,5;2,5;\n");
    EXPECT_THAT(file.names(), ElementsAre("Time|s", "Force|N"));
    EXPECT_THAT(file.rows.values[0], ElementsAre(1, 2.5));
}

} // namespace graze::testing::text_table_test
