// ProgressBar: how far a render is, on one line of a terminal; writes nothing where stderr is none.
//
// Threads  not synchronised; calls come one at a time.
#pragma once

#include <chrono>
#include <string>

namespace clients {

class ProgressBar {
public:
    // Shows only if `wanted` and standard error is a terminal.
    explicit ProgressBar(bool wanted);
    ~ProgressBar(); // wipes the line
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    // `fraction` in [0,1]; `note` stands behind the bar: "32 samples", "queued, 3rd".
    void show(double fraction, const std::string& note);
    bool visible() const { return visible_; }

private:
    bool visible_;
    std::chrono::steady_clock::time_point start_;
};

// The line without its control characters: "[#####.....]  50%  3 s left  note".
std::string progress_line(double fraction, double elapsed_s, const std::string& note);

} // namespace clients
