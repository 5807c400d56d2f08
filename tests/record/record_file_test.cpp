#include "graze/record/record_file.hpp"

#include "base/temporary_folder.hpp"
#include "graze/record/record_writer.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace graze::testing::record_file_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::size_t most = 1'000'000;

Samples read_text(const std::string& text, const RecordLayout& layout = {}) {
    const TemporaryFolder folder;
    return read_all(*open_record(folder.write("record.csv", text), layout), most);
}

/// The message about a file with this text, after the folder's name.
std::string refusal_of(const std::string& text, const RecordLayout& layout = {}) {
    const TemporaryFolder folder;
    const std::string path = folder.write("r.csv", text);
    try {
        read_all(*open_record(path, layout), most);
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(error.remedy(), "") << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message.substr(std::min(message.size(), path.size() - 5));
    }
    return "nothing";
}

RecordHeader example_header() {
    return {{"t", "s"}, {{"I", "A"}, {"q", ""}}};
}

Samples example_samples(std::size_t rows) {
    Samples samples;
    samples.clear(2);
    for (std::size_t i = 0; i < rows; ++i) {
        const double t = static_cast<double>(i) / 3;
        samples.times.push_back(t);
        samples.values[0].push_back(std::sin(t));
        samples.values[1].push_back(1e-300 * t);
    }
    return samples;
}

std::string written(const TemporaryFolder& folder, const std::string& name, std::size_t rows) {
    RecordWriter writer(folder / name, example_header());
    const Samples samples = example_samples(rows);
    Samples part;
    for (std::size_t first = 0; first < rows; first += 1000) {
        part.clear(2);
        part.append(samples, first, std::min(rows, first + 1000));
        writer.write(part);
    }
    writer.close();
    return folder / name;
}

TEST(RecordFile, HeaderGivesNamesAndUnits) {
    const TemporaryFolder folder;
    const auto record = open_record(folder.write("a.csv", "t [s], V [V],\"I\" (A),q\n0,1,2,3\n0.5,-1e-3,+2,3\n"));
    EXPECT_EQ(record->header().time.name, "t");
    EXPECT_EQ(record->header().time.unit, "s");
    ASSERT_EQ(record->header().channels.size(), 3U);
    EXPECT_EQ(record->header().channels[1].name, "I");
    EXPECT_EQ(record->header().channels[1].unit, "A");
    EXPECT_EQ(record->header().channels[2].unit, "");
    EXPECT_EQ(record->header().channel("q", "--channel"), 2U);
    EXPECT_THROW(static_cast<void>(record->header().channel("Q", "--channel")), InputError);
    const Samples all = read_all(*record, most);
    EXPECT_THAT(all.times, ElementsAre(0, 0.5));
    EXPECT_THAT(all.values[0], ElementsAre(1, -1e-3));
}

TEST(RecordFile, ReadsFormatsOfInstruments) {
    EXPECT_THAT(read_text("\xef\xbb\xbft;v\r\n0;1\r\n1;2\r\n").values[0], ElementsAre(1, 2));
    EXPECT_THAT(read_text("# made by\n% hand\n\nt [s]\tv [m/s]\n 0\t1\n1 \t 2\n").values[0], ElementsAre(1, 2));
    EXPECT_THAT(read_text("t [s] v [m/s] q\n0 1 2\n1   2 3 \n").values[1], ElementsAre(2, 3));
    EXPECT_THAT(read_text("t (s, of the clock), v\n0,1\n1,1e-400\n").values[0], ElementsAre(1, 0));
}

TEST(RecordFile, FiveColumnsWithoutAHeaderAreThoseOfTheDissertation) {
    const std::string text = "  0.0000000e+00   1.0e+00   2.0e+00   3.0e+00  -4.0e+00\n"
                             "  1.0000000e-03   1.5e+00   2.5e+00   3.5e+00  -4.5e+00\n";
    const TemporaryFolder folder;
    const auto record = open_record(folder.write("20100427_203411_06100_05920_0.dat", text));
    EXPECT_EQ(record->header().channels[3].name, "v");
    EXPECT_THAT(read_all(*record, most).values[3], ElementsAre(-4, -4.5));
    EXPECT_THAT(read_text("0 1 2\n1 3 4\n", {.columns = "t [s], V [V], I [A]"}).values[1], ElementsAre(2, 4));
}

TEST(RecordFile, ErrorsHaveTheirPlace) {
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"", "r.csv: the record is empty"},
        {"t,v\n0,1\n1,none of it\n", "r.csv:3:3: 'none of it' is not a finite number"},
        {"t,v\n0,1\n1,1e999\n", "r.csv:3:3: '1e999' is not a finite number"},
        {"t,v\n0,1\n1\n", "r.csv:3:2: the line has 1 columns instead of 2"},
        {"t v\n0 1\n1\n", "r.csv:3:2: the line has 1 columns instead of 2"},
        {"t,v\n0,1,2\n", "r.csv:2:4: this line has more than 2 columns"},
        {"t,v\n0,1\n0,2\n", "r.csv:3:1: the time 0 is not after the one before, 0"},
        {"t,v\n0;1\n", "r.csv:2:2: ';' follows a number"},
        {"t [s, V [V]\n0,1\n", "r.csv:1:3: the bracket of a unit is not closed"},
        {"t [s], V (V\n0,1\n", "r.csv:1:10: the bracket of a unit is not closed"},
        {"0,5;1,2\n", "r.csv:1:1: the 2 columns of the record are not named"},
        {"0,5 1,2\n", "r.csv:1:1: the 2 columns of the record are not named"},
        {"t,v\n0,5,1,2\n", "r.csv:2:1: there are 4 numbers instead of 2; give one for each column; decimal commas"},
        {"t,v\n0,1x\n", "r.csv:2:4: 'x' follows a number"},
        {"0,1,2\n", "r.csv:1:1: the 3 columns of the record are not named"},
        {"t\n0\n", "r.csv:1:1: there is only one column"},
        {"t,v,v\n", "r.csv:1:5: column 'v' occurs twice"},
        {"t,t\n", "r.csv:1:3: column 't' occurs twice"},
        {"t,,v\n", "r.csv:1:3: '' is not a name"},
        {"t,\x1b[2J\n", "r.csv:1:3: '\\u001b[2J' is not a name"},
        {"nan,1,2\n", "r.csv:1:1: 'nan' is not a name"},
        {"t,v\n0,\x1b[2J\n", "r.csv:2:3: '\\u001b[2J' is not a finite number"},
    };
    for (const auto& [text, message] : mistakes)
        EXPECT_THAT(refusal_of(text), HasSubstr(message)) << text;
    EXPECT_THAT(refusal_of("t,v\n0,1\n", {.columns = "t,v"}), HasSubstr("r.csv:1:1: the file has a header of its own"));
    EXPECT_THAT(refusal_of("t,v\n" + std::string(3'000'000, '1')), HasSubstr("r.csv:2:1: this line has more than"));
    EXPECT_THAT(refusal_of(std::string(9'000'000, ' ')), HasSubstr("r.csv:1:1: this line has more than"));
    EXPECT_THROW(open_record("/no/such/record"), InputError);
    EXPECT_THROW(open_record("/tmp"), InputError);
    EXPECT_THROW(open_record("/dev/zero"), InputError);
}

TEST(RecordFile, WrittenRecordsAreReadBackBitForBit) {
    const TemporaryFolder folder;
    for (const char* name : {"record.csv", "record.h5"}) {
        const std::string path = written(folder, name, 40'000);
        const auto record = open_record(path);
        EXPECT_EQ(record->header().time.unit, "s");
        EXPECT_EQ(record->header().channels[0].unit, "A");
        const Samples all = read_all(*record, most), expected = example_samples(40'000);
        EXPECT_EQ(all.times, expected.times) << name;
        EXPECT_EQ(all.values, expected.values) << name;
        EXPECT_THROW(read_all(*open_record(path), 39'999), InputError);
    }
}

/// Names that would be read back as others.
TEST(RecordFile, TextRefusesNamesThatCannotBeReadBack) {
    const TemporaryFolder folder;
    for (const char* name : {"a,b", "a;b", "a\tb", "a [b]", "#a", "", " a"}) {
        const RecordHeader header{{"t", "s"}, {{name, "V"}}};
        EXPECT_THROW(RecordWriter(folder / "r.csv", header), InputError) << name;
        EXPECT_FALSE(std::filesystem::exists(folder / "r.csv"));
    }
    RecordWriter writer(folder / "r.h5", {{"t", "s"}, {{"a,b", "V"}}});
    writer.write({{0, 1}, {{2, 3}}});
    writer.close();
    EXPECT_EQ(open_record(folder / "r.h5")->header().channels.at(0).name, "a,b");
}

TEST(RecordFile, DamagedHdf5IsRefused) {
    const TemporaryFolder folder;
    const std::string whole = contents(written(folder, "record.h5", 20'000));
    std::size_t refused = 0, tried = 0;
    for (std::size_t length = 8; length < whole.size(); length += whole.size() / 50, ++tried)
        try {
            read_all(*open_record(folder.write("cut.h5", whole.substr(0, length))), most);
        } catch (const InputError& error) {
            refused += error.remedy().empty() ? 0 : 1;
        }
    EXPECT_EQ(refused, tried);
    EXPECT_THROW(open_record(folder / "record.h5", {.group = "/elsewhere"}), InputError);
}

TEST(RecordFile, WriterRefusesInvalidSamples) {
    const TemporaryFolder folder;
    for (const char* name : {"r.csv", "r.h5"}) {
        RecordWriter writer(folder / name, example_header());
        writer.write(example_samples(2));
        EXPECT_THROW(writer.write({{1, 2}, {{1, 2}}}), InputError);                    // a channel is missing
        EXPECT_THROW(writer.write({{1, 2}, {{1, 2}, {1, 2}, {1, 2}}}), InputError);    // one too many
        EXPECT_THROW(writer.write({{1, 2}, {{1, 2}, {1}}}), InputError);               // a row is missing
        EXPECT_THROW(writer.write({{1, 2}, {{1, 2}, {1, std::nan("")}}}), InputError); // not a number
        EXPECT_THROW(writer.write({{1, std::nan("")}, {{1, 2}, {1, 2}}}), InputError);
        writer.close();
        EXPECT_THROW(writer.write(example_samples(2)), InputError);
        EXPECT_THROW(writer.close(), InputError);
        EXPECT_EQ(read_all(*open_record(folder / name), most).rows(), 2U);
    }
}

TEST(RecordFile, StoredSamplesAreChecked) {
    Samples samples = example_samples(3);
    samples.times[2] = samples.times[1];
    EXPECT_THROW(StoredSamples(example_header(), samples), InputError);
    samples.times[2] = std::nan("");
    EXPECT_THROW(StoredSamples(example_header(), samples), InputError);
    samples = example_samples(3);
    samples.values[1].pop_back();
    EXPECT_THROW(StoredSamples(example_header(), samples), InputError);
}

} // namespace graze::testing::record_file_test
