// ChildProcess: a program with an empty environment and exactly the descriptors it is given, which is gone
// for certain when this object is: killed if need be, always reaped.
//
// Threads  one thread at a time.
// Errors   start throws std::system_error if the program cannot be started.
#pragma once

#include "server/store/file_descriptor.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <sys/types.h>
#include <vector>

namespace server {

class ChildProcess {
public:
    struct End {
        int exit_code = -1; // if it exited
        int signal = 0;     // if one ended it
        std::uint64_t peak_bytes = 0;
        double cpu_s = 0;
    };

    // `descriptors` become 2, 3, 4, ... of the child; 0 and 1 are /dev/null.
    ChildProcess(const std::filesystem::path& program,
                 const std::vector<std::string>& arguments,
                 std::span<const int> descriptors);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    int pidfd() const { return pidfd_.get(); } // readable once the child has ended
    void kill();
    End wait(); // until it has ended; once

private:
    pid_t pid_ = -1;
    FileDescriptor pidfd_;
};

} // namespace server
