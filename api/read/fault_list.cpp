#include "api/read/fault_list.h"

#include "api/json/pointer.h"

#include <algorithm>
#include <utility>

namespace api {

void FaultList::add(std::string pointer, std::string code, std::string detail)
{
    add({std::move(pointer), std::move(code), std::move(detail)});
}

void FaultList::add(Problem fault)
{
    if (faults_.size() < kMostFaults)
        faults_.push_back(std::move(fault));
    else
        ++uncounted_;
}

bool FaultList::touches(std::string_view pointer) const
{
    return std::any_of(faults_.begin(), faults_.end(), [&](const Problem& fault) {
        return is_within(fault.pointer, pointer);
    });
}

std::vector<Problem> FaultList::take()
{
    std::stable_sort(faults_.begin(), faults_.end(), [](const Problem& a, const Problem& b) {
        return a.pointer == b.pointer ? a.code < b.code : comes_before(a.pointer, b.pointer);
    });
    if (uncounted_ > 0)
        faults_.push_back(
            {"", "more_faults", std::to_string(uncounted_) + " more faults are not listed here"});
    uncounted_ = 0;
    return std::exchange(faults_, {});
}

} // namespace api
