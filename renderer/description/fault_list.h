// FaultList: the faults of one description while it is checked, as many as one answer lists.
//
// Memory  bounded, however many objects share a fault.
#pragma once

#include "renderer/description/fault.h"

#include <cstddef>
#include <vector>

namespace renderer {

// Faults that one answer lists; the others are counted.
inline constexpr std::size_t kMostFaults = 1000;

// "more_faults": the last one of a list that had no room for `count` others.
Fault more_faults(std::size_t count);

class FaultList {
public:
    void add(Fault fault);
    [[nodiscard]] bool empty() const { return faults_.empty(); }
    [[nodiscard]] std::size_t count() const { return faults_.size() + unlisted_; }
    // kMostFaults at most, and then one that counts the others; leaves the list empty.
    std::vector<Fault> take();

private:
    std::vector<Fault> faults_;
    std::size_t unlisted_ = 0;
};

} // namespace renderer
