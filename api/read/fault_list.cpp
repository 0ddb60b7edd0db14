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
    if (uncounted_ > 0) {
        renderer::Fault more = renderer::more_faults(uncounted_);
        faults_.push_back({std::move(more.pointer), std::move(more.code), std::move(more.detail)});
    }
    uncounted_ = 0;
    return std::exchange(faults_, {});
}

} // namespace api
