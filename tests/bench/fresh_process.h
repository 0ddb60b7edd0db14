// in_fresh_process: does a piece of work in a child of its own, which no earlier work has left threads, devices
// or free memory in, and returns the numbers that it returns.
//
// Threads  the caller is the process's only thread.
// Errors   std::runtime_error where the child fails; its own words are on stderr by then.
#pragma once

#include <functional>
#include <vector>

namespace bench {

std::vector<double> in_fresh_process(const std::function<std::vector<double>()>& work);

} // namespace bench
