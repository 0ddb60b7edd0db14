// CountedWork: what callgrind is to count, its instructions and the lines that its simulated caches fetch, in dump
// files of its own; ray_cost.py reads them. Elsewhere it costs nothing.
//
// Threads  those that work meanwhile are counted as well.
#pragma once

#include <string>

namespace bench {

// From its making on; one at a time. The simulated caches are empty then: callgrind forgets them whenever it begins.
class CountedWork {
public:
    // Whether this runs under valgrind, and was built where its headers are.
    static bool is_possible();

    CountedWork();
    ~CountedWork();
    CountedWork(const CountedWork&) = delete;
    CountedWork& operator=(const CountedWork&) = delete;

    // What was counted since its making or the last dump, to a file that bears the label: one line, at most 400
    // characters.
    void dump(const std::string& label);
};

} // namespace bench
