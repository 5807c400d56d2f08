#include "base/special_numbers.hpp"
#include "graze/base/file_name.hpp"
#include "graze/base/require.hpp"
#include "graze/results/result_file.hpp"
#include "results/point_columns.hpp"
#include "results/result_file_state.hpp"

namespace graze {

void ResultFile::set_estimates(const std::string& run, const EstimateRecords& found) {
    const std::size_t count = found.numbers.size();
    if (!found.covariance.empty())
        require_size(found.covariance.size(), count * count, "covariances");
    state_->at_once([&] {
        const Database& database = state_->database;
        for (const char* table : {"estimates", "covariances"})
            database.prepare(fmt::format("DELETE FROM {} WHERE run = ?", table)).run(run);
        Statement insert = database.prepare(insert_into("estimates", 10));
        for (std::size_t i = 0; i < count; ++i) {
            const EstimateRecord& number = found.numbers[i];
            const Estimate& estimate = number.estimate;
            const bool known = estimate.freedom > 0;
            const auto if_known = [&](double value) { return known ? value : not_a_number; };
            insert.bind_all(run, i, number.name, number.unit, estimate.value, if_known(estimate.error),
                            if_known(estimate.value - estimate.half_width()),
                            if_known(estimate.value + estimate.half_width()), if_known(estimate.freedom), number.note);
            if (number.note.empty())
                insert.bind_null(10);
            insert.run();
        }
        Statement pair = database.prepare(insert_into("covariances", 4));
        for (std::size_t i = 0; i < found.covariance.size(); ++i)
            pair.run(run, i / count, i % count, found.covariance[i]);
    });
}

EstimateRecords ResultFile::estimates(const std::string& run) const {
    EstimateRecords found;
    const Place place{path(), 0, 0};
    Statement rows = state_->database.prepare(
        "SELECT name, unit, value, error, freedom, note FROM estimates WHERE run = ? ORDER BY position");
    rows.bind(1, std::string_view(run));
    while (rows.step()) {
        EstimateRecord& number = found.numbers.emplace_back();
        number.name = rows.text(0);
        number.unit = rows.text(1);
        require_plain_line(number.name, "name of an estimate", place);
        require_plain_line(number.unit, "unit of an estimate", place);
        number.estimate.value = rows.number(2);
        if (!rows.is_null(3) && !rows.is_null(4)) {
            number.estimate.error = rows.number(3);
            number.estimate.freedom = rows.number(4);
        }
        if (!rows.is_null(5))
            number.note = rows.text(5);
        require_plain_line(number.note, "note of an estimate", place);
    }
    const std::size_t count = found.numbers.size();
    Statement pairs = state_->database.prepare("SELECT position, other, covariance FROM covariances WHERE run = ?");
    pairs.bind(1, std::string_view(run));
    while (pairs.step()) {
        found.covariance.resize(count * count);
        const auto row = static_cast<std::size_t>(pairs.integer(0)),
                   column = static_cast<std::size_t>(pairs.integer(1));
        if (row >= count || column >= count)
            throw_contradiction(path(), fmt::format("run '{}' has a covariance of an unknown estimate", run));
        found.covariance[row * count + column] = pairs.number(2);
    }
    return found;
}

} // namespace graze
