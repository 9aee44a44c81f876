// stand_in.h -- the part of TBB that isoparm uses, on std::thread, for the thread sanitizer (preset tsan) only.
//
// The sanitizer sees no synchronisation inside libtbb, which is not built for it: with the real one it reports every
// task as a race, and no suppression tells those from ours. Here everything is visible to it. Small chunks are dealt to
// the threads in turn, before any starts: so a race is found on every run, even on one core and however short the work
// is, and no more is ordered than TBB promises. A parallel call inside a parallel call runs serially.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {

struct split {};

class global_control {
public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t threads) : before_(limit().exchange(threads)) {}
    ~global_control() { limit() = before_; }
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;
    static std::size_t active_value(parameter) { return limit(); }

private:
    static std::atomic<std::size_t>& limit() {
        static std::atomic<std::size_t> threads{4};
        return threads;
    }
    std::size_t before_;
};

template <class Value>
class blocked_range {
public:
    using const_iterator = Value;
    blocked_range(Value begin, Value end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
    Value begin() const { return begin_; }
    Value end() const { return end_; }
    std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
    std::size_t grainsize() const { return grain_; }
    bool empty() const { return !(begin_ < end_); }

private:
    Value begin_, end_;
    std::size_t grain_;
};

struct auto_partitioner {};
struct simple_partitioner {};
struct static_partitioner {};

namespace stand_in {

inline thread_local bool inside = false;

/// Runs task(0) ... task(count - 1) on several threads; throws what the first that failed threw.
template <class Task>
void run(std::size_t count, const Task& task) {
    const auto threads = std::min(count, global_control::active_value(global_control::max_allowed_parallelism));
    if (inside || threads < 2) {
        for (std::size_t i = 0; i < count; ++i) task(i);
        return;
    }
    std::atomic<bool> failed{false};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&](std::size_t thread) {
        inside = true;
        try {
            for (std::size_t i = thread; i < count && !failed.load(std::memory_order_relaxed); i += threads) task(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            failed.store(true, std::memory_order_relaxed);
        }
        inside = false;
    };
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work, i);
    work(0);
    for (auto& other : others) other.join();
    if (failure) std::rethrow_exception(failure);
}

/// At most 64 chunks of at least the grain.
template <class Value>
std::vector<blocked_range<Value>> chunks(const blocked_range<Value>& range) {
    const std::size_t step = std::max({std::size_t{1}, range.grainsize(), range.size() / 64});
    std::vector<blocked_range<Value>> parts;
    for (std::size_t at = 0; at < range.size(); at += step) {
        parts.emplace_back(range.begin() + static_cast<std::ptrdiff_t>(at),
                           range.begin() + static_cast<std::ptrdiff_t>(std::min(at + step, range.size())));
    }
    return parts;
}

}  // namespace stand_in

template <class Value, class Body, class... Partitioner>
void parallel_for(const blocked_range<Value>& range, const Body& body, const Partitioner&...) {
    const auto parts = stand_in::chunks(range);
    stand_in::run(parts.size(), [&](std::size_t i) { body(parts[i]); });
}

template <class Index, class Body, class... Partitioner>
void parallel_for(Index first, Index last, const Body& body, const Partitioner&...) {
    parallel_for(blocked_range<Index>(first, last), [&](const blocked_range<Index>& part) {
        for (Index i = part.begin(); i < part.end(); ++i) body(i);
    });
}

template <class Iterator, class Body>
void parallel_for_each(Iterator first, Iterator last, const Body& body) {
    parallel_for(std::size_t{0}, static_cast<std::size_t>(last - first),
                 [&](std::size_t i) { body(first[static_cast<std::ptrdiff_t>(i)]); });
}
template <class Container, class Body>
void parallel_for_each(Container& container, const Body& body) {
    parallel_for_each(container.begin(), container.end(), body);
}

template <class... Functions>
void parallel_invoke(const Functions&... functions) {
    stand_in::run(sizeof...(functions), [&](std::size_t wanted) {
        std::size_t at = 0;
        ((at++ == wanted ? functions() : void()), ...);
    });
}

template <class Value, class Result, class Body, class Join, class... Partitioner>
Result parallel_reduce(const blocked_range<Value>& range, const Result& identity, const Body& body, const Join& join,
                       const Partitioner&...) {
    const auto parts = stand_in::chunks(range);
    std::vector<Result> results(parts.size(), identity);
    stand_in::run(parts.size(), [&](std::size_t i) { results[i] = body(parts[i], identity); });
    Result total = identity;
    for (auto& result : results) total = join(std::move(total), std::move(result));
    return total;
}
template <class Value, class Result, class Body, class Join, class... Partitioner>
Result parallel_deterministic_reduce(const blocked_range<Value>& range, const Result& identity, const Body& body,
                                     const Join& join, const Partitioner&...) {
    return parallel_reduce(range, identity, body, join);
}

template <class Iterator, class... Order>
void parallel_sort(Iterator first, Iterator last, const Order&... order) {
    std::sort(first, last, order...);
}

class task_arena {
public:
    static constexpr int automatic = -1;
    explicit task_arena(int threads = automatic, unsigned = 1) : threads_(threads) {}
    template <class Function>
    auto execute(const Function& function) {
        if (threads_ < 1) return function();
        const global_control limit(global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_));
        return function();
    }
    int max_concurrency() const { return threads_ > 0 ? threads_ : 4; }

private:
    int threads_;
};

namespace this_task_arena {
inline int max_concurrency() {
    return static_cast<int>(global_control::active_value(global_control::max_allowed_parallelism));
}
template <class Function>
auto isolate(const Function& function) {
    return function();
}
}  // namespace this_task_arena

}  // namespace tbb

namespace oneapi {
namespace tbb = ::tbb;
}
