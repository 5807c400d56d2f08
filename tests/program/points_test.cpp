#include "branch_results.hpp"

#include <gmock/gmock.h>

namespace graze::testing::points_test {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

using Points = BranchResults;

/// CSV without the contents of quoted cells, which may contain commas.
std::string unquoted(const std::string& csv) {
    std::string text;
    bool quoted = false;
    for (const char c : csv) {
        quoted = c == '"' ? !quoted : quoted;
        text += quoted || c == '"' ? "" : std::string(1, c);
    }
    return text;
}

TEST_F(Points, ListsSpecialPointsOfABranch) {
    write_branches();
    const std::string printed = done({"points", path, "--run", "first", "--format", "csv"});
    const Csv csv(unquoted(printed));
    ASSERT_EQ(csv.rows.size(), 6U);
    EXPECT_EQ(csv.text(1, "label"), "SN1");
    EXPECT_EQ(csv.text(1, "type"), "SN");
    EXPECT_EQ(csv.number(1, "g"), 2);
    EXPECT_EQ(csv.number(1, "period"), 1);
    EXPECT_EQ(csv.number(2, "duration_1"), 1.25);
    EXPECT_EQ(csv.text(2, "signature"), "bounce");
    EXPECT_EQ(csv.text(2, "detail"), "floor");
    EXPECT_EQ(csv.number(0, "stable"), 1);
    EXPECT_EQ(csv.number(2, "multiplier"), 1.5);
    EXPECT_EQ(csv.number(3, "admissible"), 0);
    EXPECT_EQ(csv.text(3, "reason"), "event 'floor' happens within segment 1");
    EXPECT_EQ(csv.number(1, "low"), 1.9);
    EXPECT_EQ(csv.number(1, "residual"), 1e-14);
    EXPECT_EQ(csv.text(4, "label"), "EP3");
    // Each cell has one number, so that a CSV reader need not parse texts.
    EXPECT_EQ(csv.number(0, "multiplier_1_real"), 0.5);
    EXPECT_EQ(csv.number(0, "multiplier_1_imaginary"), 0);
    EXPECT_EQ(csv.number(0, "multiplier_3_real"), 0.25);
    EXPECT_EQ(csv.number(0, "multiplier_3_imaginary"), -0.125);
    // Monitors: with w = 1, g = 2 the ball flies to 1/(2g), and comes back after 2/g.
    EXPECT_EQ(csv.number(1, "height"), 0.25);
    EXPECT_EQ(csv.number(1, "period_2"), 1);
}

TEST_F(Points, ShowsMonitorsAndColumnsThatFit) {
    write_branches();
    const Printed people = run_graze({"points", path, "--run", "first"});
    EXPECT_THAT(people.out, HasSubstr("height"));
    EXPECT_THAT(people.out, HasSubstr("0.25"));
    EXPECT_THAT(people.out, Not(HasSubstr("period_2")));
    const std::string csv = run_graze({"points", path, "--run", "first", "--format", "csv"}).out;
    EXPECT_EQ(run_graze({"points", path, "--run", "first", "--format", "csv", "--type", "SN,PD,GR,EP"}).out, csv);
    // Tables show eight digits.
    EXPECT_THAT(people.out, HasSubstr("1.4285714 "));
    EXPECT_THAT(run_graze({"points", path, "--run", "first", "--digits", "17"}).out, HasSubstr("1.4285714285714286"));
    EXPECT_THAT(people.out, HasSubstr("event 'floor' happ ..."));
    const std::string all = run_graze({"points", path, "--run", "first", "--all"}).out;
    EXPECT_THAT(all, HasSubstr("event 'floor' happens within segment 1"));
    EXPECT_THAT(header(all), StartsWith("run "));
}

TEST_F(Points, ShowsOnlyTheTypesAskedFor) {
    write_branches();
    const Printed two = run_graze({"points", path, "--type", "gr,SN", "--format", "csv"});
    const Csv csv(unquoted(two.out));
    ASSERT_EQ(csv.rows.size(), 3U);
    EXPECT_EQ(csv.text(0, "label"), "SN1");
    EXPECT_EQ(csv.text(2, "run"), "second");
    EXPECT_EQ(Csv(unquoted(run_graze({"points", path, "--all", "--format", "csv"}).out)).rows.size(), 13U);
    const Csv regular(unquoted(run_graze({"points", path, "--type", "RG", "--format", "csv"}).out));
    EXPECT_EQ(regular.rows.size(), 4U);
    const Printed none = run_graze({"points", path, "--type", "NS"});
    EXPECT_EQ(none.code, 0);
    EXPECT_THAT(none.err, HasSubstr("no such points"));
}

TEST_F(Points, ShowsOtherParametersWhereTheyDiffer) {
    write_branches();
    const Printed one = run_graze({"points", path, "--run", "second", "--format", "csv"});
    EXPECT_THAT(one.out, StartsWith("run,label,type,g,period,"));
    const Printed all = run_graze({"points", path, "--format", "csv"});
    EXPECT_THAT(all.out, StartsWith("run,label,type,g,w,period,"));
    const Csv csv(unquoted(all.out));
    EXPECT_EQ(csv.number(0, "w"), 1);
    EXPECT_EQ(csv.number(6, "w"), 2);
    EXPECT_EQ(csv.text(8, "run"), "alone");
    EXPECT_EQ(csv.number(8, "g"), 4);
    {
        ResultFile file(path, ResultFile::Access::write);
        RunRecord run = run_of("third", "continue");
        std::swap(run.coordinates[0], run.coordinates[1]);
        write_run(file, run, {orbit_of("up", PointType::end, 3, true, true)});
    }
    const Printed mixed = run_graze({"points", path, "--format", "csv"});
    EXPECT_THAT(mixed.out, StartsWith("run,label,type,parameter,value,g,w,period,"));
    const Csv csv_of_both(unquoted(mixed.out));
    EXPECT_EQ(csv_of_both.text(9, "parameter"), "w");
    EXPECT_EQ(csv_of_both.number(9, "value"), 1);
    // If the table is too wide, the redundant column `value` goes; both parameters of a curve stay.
    {
        ResultFile file(path, ResultFile::Access::write);
        write_run(file, run_of("one_whose_name_takes_much_of_the_line", "orbit"),
                  {orbit_of("", PointType::end, 3, true, true)});
    }
    const std::string narrow = header(run_graze({"points", path}).out);
    for (const char* there : {" g ", " w ", " period ", " multiplier"})
        EXPECT_THAT(narrow, HasSubstr(there));
    EXPECT_THAT(narrow, Not(HasSubstr(" value ")));
}

TEST_F(Points, TableHasTheImportantColumns) {
    write_branches();
    const std::string printed = done({"points", path, "--run", "first"});
    for (const std::string& line : split(printed, '\n'))
        EXPECT_LE(line.size(), 100U) << line;
    EXPECT_THAT(printed, HasSubstr("physical"));
    EXPECT_THAT(printed, HasSubstr("floor"));
    EXPECT_THAT(printed, Not(HasSubstr("residual")));
    EXPECT_THAT(printed, Not(HasSubstr("located")));
    EXPECT_THAT(run_graze({"points", path, "--run", "second"}).out, HasSubstr("located"));
    EXPECT_TRUE(JsonCheck(run_graze({"points", path, "--format", "json"}).out).valid());
    done({"points", path, "--format", "csv", "--output", folder / "points.csv"});
    EXPECT_THAT(contents(folder / "points.csv"), StartsWith("run,label,"));
}

TEST_F(Points, MistakesAreReportedWithARemedy) {
    const auto said = [](const std::vector<std::string>& words) {
        const Printed run = run_graze(words);
        EXPECT_EQ(run.code, 2);
        return run.err;
    };
    EXPECT_THAT(said({"points", path}), HasSubstr("there is no such result file"));
    EXPECT_THAT(said({"points"}), HasSubstr("the file is missing; write graze points FILE"));
    write_sweep();
    EXPECT_THAT(said({"points", path}), HasSubstr("kind = \"continue\""));
    EXPECT_THAT(said({"points", path, "--run", "swept"}), HasSubstr("of kind sweep"));
    write_branches();
    EXPECT_THAT(said({"points", path, "--run", "frist"}), HasSubstr("did you mean 'first'?"));
    EXPECT_THAT(said({"points", path, "--type", "XX"}), HasSubstr("known are: SN, PD, NS, BP, SB, GR"));
}

TEST_F(Points, ExportsBranchesBesideOtherRuns) {
    write_sweep();
    write_branches();
    const Printed runs = run_graze({"export", path, "--what", "runs", "--format", "csv"});
    EXPECT_THAT(runs.out, HasSubstr("first,continue,complete,0,10,ball"));
    EXPECT_THAT(runs.out, HasSubstr("swept,sweep,complete,1,1,ball"));
    const Printed points = run_graze({"export", path, "--format", "csv"});
    EXPECT_EQ(points.code, 0) << points.err;
    EXPECT_THAT(points.out, StartsWith("number,chain,direction,g,"));
    EXPECT_THAT(points.err, HasSubstr("branches have other columns"));
    const Printed branch = run_graze({"export", path, "--run", "first", "--format", "csv"});
    EXPECT_THAT(branch.out, StartsWith("number,part,step,type,label,g,w,period,height,period_2,signature,"));
    EXPECT_EQ(split(branch.out, '\n').size(), 11U);
    for (const char* label : {"GR", "GR1"})
        EXPECT_EQ(
            split(run_graze({"export", path, "--run", "first", "--label", label, "--format", "csv"}).out, '\n').size(),
            2U);
    EXPECT_EQ(
        split(run_graze({"export", path, "--run", "first", "--direction", "down", "--format", "csv"}).out, '\n').size(),
        4U);
    const Csv segments(run_graze({"export", path, "--run", "second", "--what", "segments", "--format", "csv"}).out);
    ASSERT_EQ(segments.rows.size(), 2U);
    EXPECT_EQ(segments.number(1, "g"), 1.25);
    EXPECT_EQ(segments.number(1, "duration"), 1.6);
    EXPECT_EQ(segments.number(1, "start_v"), 1);
    EXPECT_EQ(segments.text(1, "label"), "GR1");
    const Csv all(run_graze({"export", path, "--what", "segments", "--format", "csv"}).out);
    EXPECT_EQ(all.rows.size(), 13U);
    const Csv multipliers(run_graze({"export", path, "--what", "multipliers", "--label", "GR", "--format", "csv"}).out);
    ASSERT_EQ(multipliers.rows.size(), 6U);
    EXPECT_EQ(multipliers.number(0, "coordinate"), 1.6);
    EXPECT_EQ(multipliers.number(1, "imaginary"), 0.125);
    EXPECT_EQ(Csv(run_graze({"export", path, "--what", "multipliers", "--format", "csv"}).out).rows.size(), 40U);
}

TEST_F(Points, ExportRefusesUnknownLabelsAndDirections) {
    write_branches();
    write_sweep();
    for (const std::string words :
         {"--run first --label GR7", "--run first --label Fold", "--run swept --label periodc",
          "--run first --direction sideways", "--what multipliers --label x"}) {
        expect_refusal("export " + path + " " + words, "no point has the");
    }
    // Valid labels and directions that no point has select no points.
    for (const std::string words : {"--run first --label NS", "--run first --label GR1", "--run swept --label chaotic",
                                    "--run swept --direction down", "--run first --direction down"})
        EXPECT_EQ(run_graze("export " + path + " " + words).code, 0) << words;
}

TEST_F(Points, ExportNamesTheTablesOfARun) {
    write_sweep();
    write_branches();
    const auto said = [&](const std::vector<std::string>& options) {
        std::vector<std::string> words{"export", path};
        words.insert(words.end(), options.begin(), options.end());
        const Printed run = run_graze(words);
        EXPECT_EQ(run.code, 2) << run.out;
        return run.err;
    };
    EXPECT_THAT(said({"--run", "first", "--what", "samples"}), HasSubstr("export its segments"));
    EXPECT_THAT(said({"--run", "swept", "--what", "segments"}), HasSubstr("export its samples"));
    EXPECT_THAT(said({"--run", "first,swept"}), HasSubstr("export one of them at a time"));
    EXPECT_THAT(said({"--what", "pints"}), HasSubstr("did you mean 'points'?"));
    done({"export", path, "--what", "samples"});
    done({"export", path, "--format", "hdf5", "--output", folder / "all.h5"});
    EXPECT_GT(std::filesystem::file_size(folder / "all.h5"), 10'000U);
}

} // namespace graze::testing::points_test
