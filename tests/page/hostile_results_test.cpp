// Result files that somebody has changed: whatever they say, the answer is JSON or an InputError.

#include "base/message_of.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/query_interruption.hpp"
#include "page/figure_json.hpp"
#include "page/grazing_json.hpp"
#include "page/json_text.hpp"
#include "page/model_json.hpp"
#include "page/motion_json.hpp"
#include "page/point_json.hpp"
#include "page/runs_json.hpp"
#include "page/special_points_json.hpp"
#include "results/run_of_model.hpp"
#include "study/study_of_every_kind.hpp"

#include <random>

namespace graze {
namespace {

using namespace std::chrono_literals;

class HostileResults : public testing::StudyOfEveryKind {
protected:
    HostileResults() {
        static const std::string computed = [this] {
            run_and_forget();
            return testing::contents(path_);
        }();
        image_ = computed;
        restore(image_);
    }
    void restore(const std::string& bytes) const {
        for (const char* more : {"results.sqlite-wal", "results.sqlite-shm", "results.sqlite-journal"})
            std::filesystem::remove(path(more));
        folder_.write("results.sqlite", bytes);
    }
    void tamper(const std::string& sql) const {
        restore(image_);
        testing::change(path_, sql);
    }
    /// Asks for all that there is. @return how many answers there were
    int answers() const {
        int count = 0;
        const auto attempt = [&](auto ask) {
            try {
                const std::string text = json_text(ask());
                EXPECT_TRUE(nlohmann::json::accept(text));
                EXPECT_EQ(text.find('<'), std::string::npos);
                ++count;
            } catch (const InputError& error) {
                EXPECT_FALSE(error.problem().empty());
            }
        };
        int asked = 0;
        const auto soon = [&] { return ++asked % 2000 == 0; };
        const QueryInterruption interruption(soon);
        attempt([&] {
            ResultFile file(path_, ResultFile::Access::read);
            file.set_patience(500ms);
            for (const RunRecord& run : file.runs()) {
                attempt([&] { return special_points_json(file, run.name); });
                attempt([&] { return figure_json(make_picture(default_picture(run), file).figure); });
                attempt([&] { return model_json(stored_model(run)); });
                const std::size_t number = run.points > 1 || run.is_followed() ? 1 : 0;
                attempt([&] { return point_json(file, run.name, number); });
                attempt([&] { return motion_json(file, run.name, number, {}, soon); });
                if (run.is_branch())
                    attempt([&] { return grazing_json(file, run.name, number); });
            }
            return runs_json(file, nullptr);
        });
        return count;
    }

    void expect_answers(const std::string& sql, const char* column) const {
        tamper(sql);
        EXPECT_GT(answers(), 10) << column;
    }

    std::string image_;
};

TEST_F(HostileResults, AnswerWhenNobodyHasChangedThem) {
    EXPECT_GT(answers(), 25);
}

TEST_F(HostileResults, AreNamedByTheNumbersThatTheyHave) {
    tamper("UPDATE branch_chain SET number = number - 1000, event_segment = 99");
    const std::string message =
        testing::message_of([&] { special_points_json(ResultFile(path_, ResultFile::Access::read), "chain"); });
    EXPECT_NE(message.find("orbit -"), std::string::npos) << message;
}

class HostileResultsSlow : public HostileResults {};

TEST_F(HostileResultsSlow, AnswerWithTextsThatAreNoText) {
    for (const char* column : {"label", "detail", "direction", "mode", "signature", "ending"})
        expect_answers(std::string("UPDATE points_sweep SET ") + column + " = CAST(x'ff3c7363726970743ec3' AS TEXT)",
                       column);
    for (const char* column : {"part", "label", "detail", "type"})
        expect_answers(std::string("UPDATE branch_chain SET ") + column + " = CAST(x'ff3c2f7363726970743ec3' AS TEXT)",
                       column);
    for (const char* column : {"mode", "ending"})
        expect_answers(std::string("UPDATE segments_chain SET ") + column + " = CAST(x'ff3c7363726970743ec3' AS TEXT)",
                       column);
    tamper("UPDATE runs SET model_name = CAST(x'ff3c7363726970743ec3' AS TEXT)");
    answers();
}

TEST_F(HostileResultsSlow, AnswerWithNumbersOutOfRange) {
    for (const char* number : {"1e308", "9e999", "NULL", "-1", "'text'"}) {
        const std::string value(number);
        tamper("UPDATE points_sweep SET duration = " + value + ", period = " + value + ", time = " + value +
               ", omega = " + value);
        answers();
        tamper("UPDATE points_motion SET time = 1e15, ending_time = " + value);
        answers();
        tamper("UPDATE segments_chain SET duration = " + value + ", start_v = " + value);
        answers();
    }
    tamper("UPDATE branch_chain SET number = number + 1000000000, omega = 1e300");
    answers();
    for (const char* number : {"-1", "1000000000000", "NULL"}) {
        tamper(std::string("UPDATE segments_chain SET segment = segment + 5; UPDATE samples_sweep SET time = ") +
               number);
        answers();
    }
}

TEST_F(HostileResultsSlow, AnswerWithAnyBytes) {
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        std::string bytes = image_;
        for (int change = 0; change < 20; ++change)
            bytes[random() % bytes.size()] = static_cast<char>(random());
        restore(bytes);
        answers();
    }
}

} // namespace
} // namespace graze
