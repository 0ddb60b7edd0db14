#include "server/store/data_folder.h"

#include "server/store/file_io.h"
#include "server/store/store.h"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <utility>

namespace server {

DataFolder::DataFolder(const std::filesystem::path& folder) : path_(std::filesystem::absolute(folder))
{
    if (!path_.has_filename()) path_ = path_.parent_path(); // "data/" is "data"
    make_folder(path_);
    const std::filesystem::path lock_file = path_ / "lock";
    FileDescriptor lock(::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640));
    if (!lock) throw_io_error("open", lock_file, errno);
    while (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
        if (errno == EINTR) continue;
        if (errno != EWOULDBLOCK) throw_io_error("lock", lock_file, errno);
        throw StoreError("the data folder " + path_.string() +
                             " is in use by another process: stop it, or give this one a folder of its own",
                         false);
    }
    lock_ = std::move(lock);
}

} // namespace server
