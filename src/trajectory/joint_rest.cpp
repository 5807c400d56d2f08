#include "trajectory/joint_rest.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace graze {

namespace {

/// Solves equations with a positive definite matrix. @param a rows of the matrix, each followed by its right-hand side
std::vector<double> solved(std::vector<double> a) {
    std::size_t m = 0;
    while (m * (m + 1) < a.size())
        ++m;
    for (std::size_t k = 0; k < m; ++k)
        for (std::size_t r = 0; r < m; ++r)
            if (const double factor = a[r * (m + 1) + k] / a[k * (m + 1) + k]; r != k)
                for (std::size_t c = k; c <= m; ++c)
                    a[r * (m + 1) + c] -= factor * a[k * (m + 1) + c];
    std::vector<double> result;
    for (std::size_t k = 0; k < m; ++k)
        result.push_back(a[k * (m + 1) + m] / a[k * (m + 1) + k]);
    return result;
}

/// With acceleration, speeds that have fallen by this factor leave no time; those of impacts at one instant leave no
/// gap.
constexpr double no_time = 1e-13, no_speed = 1e-18;
/// Speeds of contacts that collide in turn differ by at most this factor.
constexpr double alike = 1e3;
/// Without acceleration, speeds must have fallen so far that the impacts never end.
constexpr double endless = 1e-6;
/// Gaps this close to zero, relative to the terms that they are the sum of, close together.
constexpr double together = 8 * epsilon;

class Follower {
public:
    explicit Follower(const NearbyContacts& contacts)
        : n_(contacts.size()), gap_(contacts.gap), rate_(contacts.rate), free_(contacts.acceleration),
          restitution_(contacts.restitution), response_(contacts.response), last_(n_, 0), impulses_(n_, 0.0) {
        for (double& gap : gap_)
            gap = std::max(gap, 0.0); // round-off
        for (const double acceleration : free_)
            strongest_ = std::max(strongest_, std::abs(acceleration));
    }

    JointRest run(std::size_t most_impacts, bool at_once) {
        const std::size_t all = (std::size_t{1} << n_) - 1;
        const auto [fastest, widest] = size();
        meet(most_impacts);
        if (const std::size_t rest = touching(); impacts_ > 0 && (rest == all || (at_once && rest != 0)))
            return rest_at_once(rest); // forces decide later whether they stay closed
        if (supported(all).closed != all)
            return {JointRest::Fate::leaves, 0, impacts_};
        while (impacts_ <= most_impacts) {
            meet(most_impacts);
            now_ = supported(touching());
            const auto [speed, gap] = size();
            const bool hardly_moves = strongest_ > 0 ? speed <= no_time * fastest && gap <= no_time * widest
                                                     : speed <= endless * fastest && standing_ > 4 * n_;
            if (now_.closed == all || hardly_moves)
                return {JointRest::Fate::rest, time_, impacts_};
            const auto next = next_impact();
            if (!next)
                return {JointRest::Fate::leaves, time_, impacts_};
            if (!close(next->first))
                fly(next->first, next->second);
            shut_together();
        }
        return {JointRest::Fate::undecided, time_, impacts_};
    }

private:
    /// Contacts that forces keep closed, as bits, and the accelerations of all gaps.
    struct Support {
        std::size_t closed = 0;
        std::vector<double> acceleration;
    };

    JointRest rest_at_once(std::size_t set) const {
        JointRest result{JointRest::Fate::rest, 0, impacts_, impulses_, std::vector<double>(n_, 0.0)};
        for (std::size_t i = 0; i < n_; ++i)
            result.rests.push_back((set >> i & 1U) != 0);
        return result;
    }

    /// Some contacts may come to rest at each other while others are still open: infinitely many impacts between which
    /// no time passes any more.
    void shut_together() {
        if (standing_ <= 8 * n_ || strongest_ == 0)
            return;
        for (std::size_t i = 0; i < n_; ++i)
            if (impacts_ - last_[i] < 4 * n_)
                gap_[i] = 0;
        standing_ = 0;
    }

    double response(std::size_t i, std::size_t j) const { return response_[i * n_ + j]; }
    bool is_closed(std::size_t i) const { return (now_.closed >> i & 1U) != 0; }

    /// Makes the impacts of this instant. Infinitely many may follow each other without time between them: their speeds
    /// fall like powers, and end at zero.
    void meet(std::size_t most_impacts) {
        double fastest = 0;
        for (std::size_t i = 0; i < n_; ++i)
            if (gap_[i] == 0)
                fastest = std::max(fastest, std::abs(rate_[i]));
        const double slow = std::max(no_speed * fastest, no_speed * time_ * strongest_);
        const std::size_t first = impacts_;
        std::size_t slow_ones = 0;
        for (bool hit = true; hit && impacts_ <= most_impacts;) {
            hit = false;
            for (std::size_t i = 0; i < n_ && !hit; ++i) {
                hit = gap_[i] == 0 && rate_[i] < 0;
                if (hit) {
                    slow_ones = rate_[i] >= -slow ? slow_ones + 1 : 0;
                    strike(i);
                }
            }
            if (slow_ones > 2 * n_)
                for (std::size_t i = 0; i < n_; ++i)
                    if (last_[i] > first && gap_[i] == 0 && std::abs(rate_[i]) <= alike * slow)
                        rate_[i] = 0;
        }
        for (std::size_t i = 0; i < n_; ++i)
            if (gap_[i] == 0 && std::abs(rate_[i]) <= slow)
                rate_[i] = 0;
    }

    void strike(std::size_t i) {
        last_[i] = ++impacts_;
        const double before = rate_[i], impulse = -(1 + restitution_[i]) * before / response(i, i);
        for (std::size_t j = 0; j < n_; ++j)
            rate_[j] += response(j, i) * impulse;
        impulses_[i] += impulse;
        rate_[i] = -restitution_[i] * before;
    }

    std::size_t touching() const {
        std::size_t set = 0;
        for (std::size_t i = 0; i < n_; ++i)
            if (gap_[i] == 0 && rate_[i] == 0)
                set |= std::size_t{1} << i;
        return set;
    }

    /// Of the subsets of touching contacts, the first, those with most contacts first, whose forces do not pull while
    /// the others do not approach.
    const Support& supported(std::size_t touching) {
        const auto known = supports_.find(touching);
        if (known != supports_.end())
            return known->second;
        std::vector<std::size_t> subsets;
        for (std::size_t set = touching;; set = (set - 1) & touching) {
            subsets.push_back(set);
            if (set == 0)
                break;
        }
        const auto members = [&](std::size_t set) {
            std::size_t count = 0;
            for (; set != 0; set &= set - 1)
                ++count;
            return count;
        };
        std::ranges::stable_sort(subsets,
                                 [&](std::size_t one, std::size_t other) { return members(one) > members(other); });
        Support result{0, free_};
        for (const std::size_t set : subsets)
            if (const auto found = carried(set, touching)) {
                result = {set, *found};
                break;
            }
        return supports_.emplace(touching, std::move(result)).first->second;
    }

    /// Returns the accelerations if these contacts are closed; none if a force pulls or another touching one
    /// approaches.
    std::optional<std::vector<double>> carried(std::size_t set, std::size_t touching) const {
        std::vector<std::size_t> members;
        for (std::size_t i = 0; i < n_; ++i)
            if ((set >> i & 1U) != 0)
                members.push_back(i);
        const std::size_t m = members.size();
        std::vector<double> a(m * (m + 1)); // rows of the matrix with the right-hand side; it is positive definite
        for (std::size_t r = 0; r < m; ++r) {
            for (std::size_t c = 0; c < m; ++c)
                a[r * (m + 1) + c] = response(members[r], members[c]);
            a[r * (m + 1) + m] = -free_[members[r]];
        }
        const std::vector<double> forces = solved(std::move(a));
        std::vector<double> acceleration = free_, terms(n_);
        for (std::size_t i = 0; i < n_; ++i)
            terms[i] = std::abs(free_[i]);
        constexpr double noise = 1e-12;
        for (std::size_t k = 0; k < m; ++k) {
            const double force = forces[k];
            if (!(force * response(members[k], members[k]) >= -noise * strongest_))
                return std::nullopt;
            for (std::size_t i = 0; i < n_; ++i) {
                acceleration[i] += response(i, members[k]) * force;
                terms[i] += std::abs(response(i, members[k]) * force);
            }
        }
        for (std::size_t i = 0; i < n_; ++i) {
            if ((set >> i & 1U) != 0)
                acceleration[i] = 0;
            else if (std::abs(acceleration[i]) <= noise * terms[i])
                acceleration[i] = 0;
            if ((touching >> i & 1U) != 0 && acceleration[i] < 0)
                return std::nullopt;
        }
        return acceleration;
    }

    /// Returns the greatest speed that gaps have or reach, and the greatest gap.
    std::pair<double, double> size() const {
        double speed = 0, gap = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            speed = std::max({speed, std::abs(rate_[i]), std::sqrt(2 * strongest_ * gap_[i])});
            gap = std::max({gap, gap_[i], strongest_ > 0 ? rate_[i] * rate_[i] / (2 * strongest_) : 0});
        }
        return {speed, gap};
    }

    /// Returns the contact that closes next, and when.
    std::optional<std::pair<std::size_t, double>> next_impact() const {
        std::optional<std::pair<std::size_t, double>> next;
        for (std::size_t i = 0; i < n_; ++i) {
            const double time = is_closed(i) ? -1 : fall_time(gap_[i], rate_[i], now_.acceleration[i]);
            if (time >= 0 && (!next || time < next->second))
                next = {i, time};
        }
        return next;
    }

    /// Returns when g + u t + a t^2/2 falls to zero; negative if it does not.
    static double fall_time(double g, double u, double a) {
        const double discriminant = u * u - 2 * a * g;
        if (a < 0)
            return u > 0 ? (u + std::sqrt(discriminant)) / -a : 2 * g / (std::sqrt(discriminant) - u);
        return u < 0 && discriminant >= 0 ? 2 * g / (std::sqrt(discriminant) - u) : -1;
    }

    void fly(std::size_t contact, double time) {
        for (std::size_t j = 0; j < n_; ++j) {
            if (is_closed(j))
                continue;
            const double a = now_.acceleration[j],
                         terms = gap_[j] + std::abs(rate_[j]) * time + std::abs(a) * time * time / 2;
            gap_[j] = gap_[j] + time * (rate_[j] + a * time / 2);
            if (gap_[j] <= together * terms || j == contact)
                gap_[j] = 0;
            rate_[j] += a * time;
        }
        rate_[contact] = std::min(rate_[contact], 0.0);
        time_ += time;
        standing_ = time <= epsilon * time_ ? standing_ + 1 : 0;
    }

    /// A contact that bounces alone, without hitting a closed one, comes to rest before any other closes: all its
    /// impulses together follow from its own rest, and so does what they do to the other gaps.
    bool close(std::size_t i) {
        const double u = rate_[i], a = now_.acceleration[i], e = restitution_[i];
        if (gap_[i] != 0 || !(u > 0) || !(a < 0) || !(e < 1))
            return false;
        const double time = 2 * u / (-a * (1 - e)), highest = u * u / (-2 * a);
        const double impulse = -(u + a * time) / response(i, i), moment = -(u + a * time / 2) * time / response(i, i);
        for (std::size_t j = 0; j < n_; ++j) {
            if (j == i)
                continue;
            const double share = response(j, i) / response(i, i);
            if (is_closed(j)) {
                if (share != 0)
                    return false;
                continue;
            }
            // The gap is that of its flight, less what is missing of a free flight of the one that bounces.
            const double rate = rate_[j] - share * u, acceleration = now_.acceleration[j] - share * a,
                         start = gap_[j] + std::min(0.0, share * highest);
            const double end = start + time * (rate + acceleration * time / 2);
            const double turn = acceleration > 0 && rate < 0 ? -rate / acceleration : 0;
            const double low = turn > 0 && turn < time ? start + rate * turn / 2 : std::min(start, end);
            if (!(low > 0))
                return false;
        }
        for (std::size_t j = 0; j < n_; ++j) {
            if (is_closed(j) || j == i)
                continue;
            gap_[j] += time * (rate_[j] + now_.acceleration[j] * time / 2) + response(j, i) * moment;
            rate_[j] += now_.acceleration[j] * time + response(j, i) * impulse;
        }
        rate_[i] = 0;
        time_ += time;
        ++impacts_;
        return true;
    }

    std::size_t n_;
    std::vector<double> gap_, rate_, free_, restitution_, response_;
    std::map<std::size_t, Support> supports_; ///< by the contacts that touch
    Support now_;
    double strongest_ = 0; ///< greatest acceleration
    double time_ = 0;
    std::size_t impacts_ = 0;
    std::vector<std::size_t> last_; ///< of each contact, the number of its last impact
    std::vector<double> impulses_;  ///< sum of those of each contact, until the first flight
    std::size_t standing_ = 0;      ///< flights that have been too short to change the time
};

} // namespace

JointRest joint_rest(const NearbyContacts& contacts, std::size_t most_impacts, bool at_once) {
    JointRest result = Follower(contacts).run(most_impacts, at_once);
    if (result.fate != JointRest::Fate::rest || !result.rests.empty())
        return result;
    result.rests.assign(contacts.size(), true);
    const std::size_t n = contacts.size();
    const double time = result.duration;
    std::vector<double> impulses, moments; // equations by which rates and gaps are zero at the end
    for (std::size_t i = 0; i < n; ++i) {
        for (auto* rows : {&impulses, &moments})
            rows->insert(rows->end(), &contacts.response[i * n], &contacts.response[i * n] + n);
        impulses.push_back(-(contacts.rate[i] + contacts.acceleration[i] * time));
        moments.push_back(-(contacts.gap[i] + time * (contacts.rate[i] + contacts.acceleration[i] * time / 2)));
    }
    result.impulses = solved(std::move(impulses));
    result.moments = solved(std::move(moments));
    return result;
}

} // namespace graze
