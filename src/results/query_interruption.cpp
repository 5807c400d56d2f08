#include "graze/results/query_interruption.hpp"

#include <utility>

namespace graze {

namespace {

thread_local const QueryInterruption* of_this_thread = nullptr;

} // namespace

QueryInterruption::QueryInterruption(std::function<bool()> interrupted)
    : interrupted_(std::move(interrupted)), before_(std::exchange(of_this_thread, this)) {}

QueryInterruption::~QueryInterruption() {
    of_this_thread = before_;
}

bool QueryInterruption::requested() {
    return of_this_thread != nullptr && of_this_thread->interrupted_ && of_this_thread->interrupted_();
}

} // namespace graze
