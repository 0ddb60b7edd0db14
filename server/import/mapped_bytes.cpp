#include "server/import/mapped_bytes.h"

#include <sys/mman.h>
#include <sys/stat.h>

namespace server {

MappedBytes map_file(int fd)
{
    struct stat state {};
    if (::fstat(fd, &state) != 0 || state.st_size <= 0) return {};
    const auto size = static_cast<std::size_t>(state.st_size);
    void* const data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd, 0);
    if (data == MAP_FAILED) return {};
    return {{static_cast<const std::byte*>(data), size},
            std::shared_ptr<const void>(
                data, [size](const void* mapped) { ::munmap(const_cast<void*>(mapped), size); })};
}

} // namespace server
