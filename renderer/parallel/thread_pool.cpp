#include "renderer/parallel/thread_pool.h"

#include "renderer/math/floating_point_mode.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <pthread.h>
#include <sched.h>
#include <thread>
#include <utility>
#include <vector>

namespace renderer {

unsigned usable_cores()
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
    return std::max(1u, std::thread::hardware_concurrency());
}

namespace {

// For so long a thread that waits stays awake: longer than most of what a caller does between loops that belong
// together.
constexpr std::chrono::microseconds kPatience{500};

// Until it is no longer `old`. `on_sleep` is called before the thread sleeps.
template <typename OnSleep>
void wait_for_change(const std::atomic<std::uint32_t>& value, std::uint32_t old, OnSleep&& on_sleep)
{
    const auto awake_until = std::chrono::steady_clock::now() + kPatience;
    while (value.load(std::memory_order_acquire) == old) {
        if (std::chrono::steady_clock::now() > awake_until) {
            on_sleep();
            value.wait(old, std::memory_order_acquire);
            return;
        }
        std::this_thread::yield(); // to whoever shares the processor
    }
}

} // namespace

// One loop at a time: threads wait until `loops` moves, enter if they still find it open, claim items from `next`,
// and leave.
struct ThreadPool::State {
    struct Loop {
        std::size_t items = 0;
        const std::function<void(std::size_t, unsigned)>* body = nullptr;
        std::stop_token stop;
        unsigned max_workers = 0;
        std::atomic<std::size_t> next{0};
        std::mutex mutex;
        std::exception_ptr error; // the first one; under `mutex`
    };

    // A thread that sleeps, or has not begun yet, is woken on another processor than its waker's. Linux means to
    // do that itself, but as a guest of KVM it often puts both on one, though another is idle, until a tick of the
    // clock, 4 ms later or more, parts them. Awake it may run on what was usable when it was woken.
    class Sleep {
    public:
        // The waker's. A refusal changes nothing but the time that the loop takes.
        void keep_from(int processor, pthread_t thread)
        {
            Phase expected = Phase::asleep;
            if (!phase_.compare_exchange_strong(expected, Phase::being_kept, std::memory_order_acquire))
                return;
            bool kept = false;
            if (pthread_getaffinity_np(thread, sizeof usable_, &usable_) == 0) {
                cpu_set_t others = usable_;
                CPU_CLR(static_cast<unsigned>(processor), &others);
                kept = CPU_COUNT(&others) > 0 && pthread_setaffinity_np(thread, sizeof others, &others) == 0;
            }
            phase_.store(kept ? Phase::kept : Phase::awake, std::memory_order_release);
        }

        // The thread's own.
        void begin() { phase_.store(Phase::asleep, std::memory_order_release); }
        void end()
        {
            Phase now = phase_.load(std::memory_order_acquire);
            while (now == Phase::being_kept ||
                   (now == Phase::asleep &&
                    !phase_.compare_exchange_weak(now, Phase::awake, std::memory_order_acquire))) {
                std::this_thread::yield();
                now = phase_.load(std::memory_order_acquire);
            }
            if (now != Phase::kept) return;
            sched_setaffinity(0, sizeof usable_, &usable_);
            phase_.store(Phase::awake, std::memory_order_relaxed);
        }

    private:
        enum class Phase { awake, asleep, being_kept, kept };
        std::atomic<Phase> phase_{Phase::asleep};
        cpu_set_t usable_{}; // to the thread, once it is awake
    };

    static constexpr std::uint32_t kOpen = std::uint32_t{1} << 31;

    explicit State(unsigned count) : sleeps(count) {}
    ~State() // also where not all threads could be made
    {
        closing.store(true, std::memory_order_relaxed);
        next_loop();
    }

    std::mutex callers;                   // one run() at a time
    std::atomic<std::uint32_t> loops{0};  // that were opened; moves once more at the end
    std::atomic<std::uint32_t> inside{0}; // threads in the loop; kOpen while more may enter
    std::atomic<bool> closing{false};
    Loop* loop = nullptr;              // of those inside
    std::vector<Sleep> sleeps;         // of each thread
    std::vector<std::jthread> threads; // the last member: they use the others

    static void work_on(Loop& l, unsigned worker)
    {
        try {
            while (!l.stop.stop_requested()) {
                const std::size_t item = l.next.fetch_add(1, std::memory_order_relaxed);
                if (item >= l.items) return;
                (*l.body)(item, worker);
            }
        } catch (...) {
            l.next.store(l.items, std::memory_order_relaxed);
            const std::lock_guard lock(l.mutex);
            if (!l.error) l.error = std::current_exception();
        }
    }

    bool enter()
    {
        std::uint32_t now = inside.load(std::memory_order_relaxed);
        while ((now & kOpen) != 0)
            if (inside.compare_exchange_weak(now, now + 1, std::memory_order_acquire)) return true;
        return false;
    }

    void leave()
    {
        if (inside.fetch_sub(1, std::memory_order_acq_rel) == 1) inside.notify_one();
    }

    void thread_main(unsigned worker)
    {
        const DefaultFloatingPoint whatever_the_maker_had;
        Sleep& sleep = sleeps[worker - 1];
        std::uint32_t seen = 0;
        loops.wait(seen, std::memory_order_acquire);
        for (;;) {
            sleep.end();
            seen = loops.load(std::memory_order_acquire);
            if (closing.load(std::memory_order_relaxed)) return;
            if (enter()) {
                if (worker < loop->max_workers) work_on(*loop, worker);
                leave();
            }
            wait_for_change(loops, seen, [&] { sleep.begin(); });
        }
    }

    void open(Loop& l)
    {
        loop = &l;
        inside.store(kOpen, std::memory_order_release);
        const int here = sched_getcpu();
        for (std::size_t i = 0; i < std::min<std::size_t>(l.max_workers, l.items) - 1; ++i)
            sleeps[i].keep_from(here, threads[i].native_handle());
        next_loop();
    }

    void next_loop()
    {
        loops.fetch_add(1, std::memory_order_release);
        loops.notify_all();
    }

    // A thread that comes late finds nothing to enter.
    void close()
    {
        std::uint32_t left = inside.fetch_and(~kOpen, std::memory_order_acq_rel) & ~kOpen;
        for (; left != 0; left = inside.load(std::memory_order_acquire))
            wait_for_change(inside, left, [] {});
    }
};

ThreadPool::ThreadPool(unsigned threads)
{
    const unsigned count = threads != 0 ? threads : usable_cores();
    state_ = std::make_unique<State>(count - 1);
    for (unsigned worker = 1; worker < count; ++worker)
        state_->threads.emplace_back([state = state_.get(), worker] { state->thread_main(worker); });
}

ThreadPool::~ThreadPool() = default;

unsigned ThreadPool::size() const
{
    return static_cast<unsigned>(state_->threads.size()) + 1;
}

void ThreadPool::run(std::size_t items,
                     const std::function<void(std::size_t, unsigned)>& body,
                     std::stop_token stop,
                     unsigned max_workers)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    const std::lock_guard one_caller(state_->callers);
    State::Loop loop;
    loop.items = items;
    loop.body = &body;
    loop.stop = std::move(stop);
    loop.max_workers = max_workers == 0 ? size() : std::min(max_workers, size());
    const bool shared = loop.max_workers > 1 && items > 1;
    if (shared) state_->open(loop);
    State::work_on(loop, 0);
    if (shared) state_->close();
    if (loop.error) std::rethrow_exception(loop.error);
}

void ThreadPool::run_near(std::size_t items,
                          const std::function<void(std::size_t, unsigned)>& body,
                          std::stop_token stop)
{
    struct alignas(128) Part {
        std::atomic<std::size_t> next;
        std::size_t end;
    };
    std::vector<Part> parts(size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
        parts[p].next = items * p / parts.size();
        parts[p].end = items * (p + 1) / parts.size();
    }
    const auto work_on = [&](Part& part, unsigned worker) {
        while (!stop.stop_requested()) {
            const std::size_t item = part.next.fetch_add(1, std::memory_order_relaxed);
            if (item >= part.end) return;
            body(item, worker);
        }
    };
    run(parts.size(), [&](std::size_t, unsigned worker) {
        try {
            for (std::size_t k = 0; k < parts.size(); ++k)
                work_on(parts[(worker + k) % parts.size()], worker);
        } catch (...) {
            for (Part& part : parts)
                part.next.store(part.end, std::memory_order_relaxed);
            throw;
        }
    });
}

} // namespace renderer
