// FaultList: the faults of one request while it is read.
#pragma once

#include "api/problem.h"
#include "renderer/description/fault_list.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace api {

using renderer::kMostFaults;

class FaultList {
public:
    void add(std::string pointer, std::string code, std::string detail);
    void add(Problem fault);

    [[nodiscard]] bool empty() const { return faults_.empty(); }
    [[nodiscard]] std::size_t count() const { return faults_.size() + uncounted_; }
    // Some fault is at `pointer` or below: rules that join several members then stay silent.
    [[nodiscard]] bool touches(std::string_view pointer) const;

    // In the order of their pointers, whatever the order of members in the request; leaves the list empty.
    std::vector<Problem> take();

private:
    std::vector<Problem> faults_;
    std::size_t uncounted_ = 0; // found after kMostFaults
};

} // namespace api
