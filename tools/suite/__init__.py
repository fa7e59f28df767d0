# SPDX-License-Identifier: MIT
"""The yardstick (``tools/yardstick``): how well and how fast rlvc and other learners solve known tasks.

    options     the command line             tasks       the tasks, and the bars that rlvc must meet
    worlds      worlds solved exactly        learners/   rlvc and its peers, one a file
    runs        one run, and many at a time  report      the table
"""
