#include "page/page_html.hpp"
#include "run_graze.hpp"

#include <fstream>

namespace graze::testing::plot_page_test {

using ::testing::HasSubstr;
using ::testing::Not;

class PlotPage : public ::testing::Test {
protected:
    PlotPage() {
        folder_.write("s.toml", "name = \"s\"\nmodel = \"impact-oscillator\"\n"
                                "[runs.one]\nkind = \"simulate\"\nset = { omega = 2.8 }\nperiods = 5\n"
                                "[runs.two]\nkind = \"simulate\"\nset = { omega = 2.6 }\nperiods = 5\n");
        done({"run", folder_ / "s.toml", "--output", results_, "--no-pictures", "--quiet"});
    }
    std::string contents(const std::string& path) const {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    TemporaryFolder folder_;
    const std::string results_ = folder_ / "results", page_ = folder_ / "page.html";
};

TEST_F(PlotPage, OneFileHasAllRuns) {
    if (page_html().empty())
        return expect_refusal(run_graze({"plot", results_, "--output", page_}), "built without its page");
    EXPECT_EQ(done({"plot", results_, "--output", page_, "--title", "for you"}), page_ + "\n");
    const std::string page = contents(page_);
    EXPECT_THAT(page, HasSubstr("id=\"stored\""));
    EXPECT_THAT(page, HasSubstr("\"title\":\"for you\""));
    for (const char* run : {"\"one/0\":", "\"two/0\":"})
        EXPECT_THAT(page, HasSubstr(run));
    done({"plot", results_, "--run", "two", "--output", page_});
    EXPECT_THAT(contents(page_), Not(HasSubstr("\"one/0\":")));
}

TEST_F(PlotPage, KeepsNoDataBesideIt) {
    expect_refusal(run_graze({"plot", results_, "--output", page_, "--data", folder_ / "d"}), "has its data in itself");
    EXPECT_EQ(contents(page_), "");
}

} // namespace graze::testing::plot_page_test
