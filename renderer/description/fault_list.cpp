#include "renderer/description/fault_list.h"

#include <string>
#include <utility>

namespace renderer {

Fault more_faults(std::size_t count)
{
    return {"", "more_faults", std::to_string(count) + " more faults are not listed here"};
}

void FaultList::add(Fault fault)
{
    if (faults_.size() < kMostFaults)
        faults_.push_back(std::move(fault));
    else
        ++unlisted_;
}

std::vector<Fault> FaultList::take()
{
    if (unlisted_ > 0) faults_.push_back(more_faults(unlisted_));
    unlisted_ = 0;
    return std::exchange(faults_, {});
}

} // namespace renderer
