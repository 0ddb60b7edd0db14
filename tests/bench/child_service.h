// ChildService: a real heliographd in a folder of its own, for measuring it from outside.
//
// Errors  std::runtime_error when it does not come up; the destructor stops it and removes the folder.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace bench {

class ChildService {
public:
    explicit ChildService(const std::vector<std::string>& extra_options = {});
    ~ChildService();
    ChildService(const ChildService&) = delete;
    ChildService& operator=(const ChildService&) = delete;

    const std::string& url() const { return url_; }
    const std::filesystem::path& folder() const { return folder_; }
    double resident_mib() const; // VmRSS
    double peak_mib() const;     // VmHWM

private:
    std::filesystem::path folder_;
    std::string url_;
    pid_t pid_ = -1;
};

} // namespace bench
