#pragma once

#include "graze/study/stored_study.hpp"
#include "study/study_of_every_kind.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

namespace graze::testing {

/// The results of a study with a run of every kind, computed once for all tests of a suite.
class PageResults : public ::testing::Test {
protected:
    static const ResultFile& file() { return computed().file; }
    static const Study& study() { return computed().study; }
    /// The first special point of a branch with this type.
    static OrbitRecord special_point(const std::string& run, PointType type) {
        for (const OrbitRecord& record : file().orbits(run, true))
            if (record.point.type == type)
                return record;
        throw std::out_of_range(run);
    }

private:
    struct EveryKind : StudyOfEveryKind {
        EveryKind() { run_and_forget(); }
        void TestBody() override {}
        using StudyOfEveryKind::path;
    };
    struct Computed {
        EveryKind folder;
        ResultFile file{folder.path("results.sqlite"), ResultFile::Access::read};
        Study study = stored_study(file);
    };
    static const Computed& computed() {
        static const Computed one;
        return one;
    }
};

/// The numbers of a list; those that are null are not a number.
inline std::vector<double> numbers_in(const nlohmann::json& list) {
    std::vector<double> numbers;
    for (const nlohmann::json& one : list)
        numbers.push_back(one.is_null() ? std::numeric_limits<double>::quiet_NaN() : one.get<double>());
    return numbers;
}

} // namespace graze::testing
