# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the runs that are missing, several at a time, and says how far it has come."""

import queue
import threading
import time


def make_missing(study, runs, settings, jobs, name_of, say):
    """Runs every setting as often as the study repeats it; those that are there are not made again.

    All settings come once before any comes a second time, so that a busy hour does not fall on one of
    them; one that fails is not repeated. `say` takes a line. KeyboardInterrupt ends the runs under way; those that are complete stay.
    """
    waiting = [(setting, number) for number in range(1, study.repeats + 1) for setting in settings
               if number in runs.missing(setting)]
    made_before = len(settings) * study.repeats - len(waiting)
    if made_before:
        say(f"{made_before} of {len(settings) * study.repeats} runs are there from earlier")
    if not waiting:
        return
    todo, done = queue.Queue(), queue.Queue()
    for task in waiting:
        todo.put(task)

    def work():
        while True:
            try:
                setting, number = todo.get_nowait()
            except queue.Empty:
                return
            try:
                failed = number > 1 and number not in runs.missing(setting)
                done.put((setting, None if failed else runs.make(setting, number), None))
            except BaseException as problem:  # told by the main thread
                done.put((setting, None, problem))
                return

    start = time.monotonic()
    workers = [threading.Thread(target=work) for _ in range(min(jobs, len(waiting)))]
    for worker in workers:
        worker.start()
    try:
        for count in range(1, len(waiting) + 1):
            setting, record, problem = done.get()
            if problem is not None:
                raise problem
            left = (time.monotonic() - start) / count * (len(waiting) - count)
            if record is None:
                continue
            told = f"FAILED: {record.failure}" if record.failure else f"{record.processor_time:.1f} s"
            end = f"; {duration(left)} left, ends {time.strftime('%H:%M', time.localtime(time.time() + left))}"
            say(f"[{count:>{len(str(len(waiting)))}}/{len(waiting)}] {name_of(setting)}: {told}"
                + (end if count < len(waiting) else ""))
    except BaseException:
        runs.stop()
        raise
    finally:
        for worker in workers:
            worker.join()


def duration(seconds):
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"
