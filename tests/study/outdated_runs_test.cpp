#include "graze/study/outdated_runs.hpp"

#include "graze/study/stored_study.hpp"

#include "study_of_every_kind.hpp"

#include <gmock/gmock.h>

namespace graze::outdated_runs_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class OutdatedRuns : public testing::StudyOfEveryKind {
protected:
    std::string computed() const {
        run_and_forget();
        return path_;
    }
    static StudyRun& run_of(Study& study, const std::string& name) {
        return *std::ranges::find(study.runs, name, &StudyRun::name);
    }

    const ResultFile file_{computed(), ResultFile::Access::read};
    Study study_ = stored_study(file_);
};

TEST_F(OutdatedRuns, AreNoneWhereNothingHasChanged) {
    EXPECT_THAT(outdated_runs(study_, file_), IsEmpty());
}

TEST_F(OutdatedRuns, AreThoseOfAnotherModelAndThoseThatNeedThem) {
    run_of(study_, "sweep").model.set_parameter("zeta", 0.04);
    EXPECT_THAT(outdated_runs(study_, file_), ElementsAre("basin", "sweep"));
    run_of(study_, "motion").motion().simulation.tolerance *= 2;
    EXPECT_THAT(outdated_runs(study_, file_), ElementsAre("basin", "motion", "sweep"));
}

TEST_F(OutdatedRuns, AreNoRunsWithoutResults) {
    run_of(study_, "from_table").name = "new";
    EXPECT_THAT(outdated_runs(study_, file_), IsEmpty());
}

} // namespace graze::outdated_runs_test
