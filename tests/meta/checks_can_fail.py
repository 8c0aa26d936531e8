# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Each check finds the fault it is for, in a small tree made for it, and none in a clean one.

Usage: checks_can_fail.py CLANG_FORMAT COMPILER
"""

import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import commands
import format as format_check
import headers_alone
import keywords
import layering
import licences
import links
import registered

CLANG_FORMAT, COMPILER = sys.argv.pop(1), sys.argv.pop(1)
HEAD = "// SPDX-FileCopyrightText: 2026 The GranFlux developers\n// SPDX-License-Identifier: {}\n"
BSD = HEAD.format("BSD-3-Clause")
GPL = HEAD.format("GPL-2.0-or-later")


class Checks(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.write(".clang-format", "BasedOnStyle: LLVM\n")
        for script in registered.SCRIPTS:
            self.write(script, BSD).chmod(0o755)
        self.write("cfd_lib/CMakeLists.txt", BSD + "add_library(a src/a.cpp include/a.hpp)\n")
        self.write("cfd_lib/src/a.cpp", BSD + "#include <granflux/cfd/a.hpp>\n")
        self.write("cfd_lib/include/a.hpp", BSD + "int a();\n")
        self.write("coupling/src/b.cpp", BSD + "#include <granflux/cfd/a.hpp>\n")
        self.write("coupling/include/granflux/b.hpp", BSD + "int b();\n")
        self.write("coupling/CMakeLists.txt", BSD + "add_library(b src/b.cpp include/granflux/b.hpp)\n")

    def tearDown(self):
        shutil.rmtree(self.root)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def assert_one_fault(self, faults, text):
        self.assertEqual(len(faults), 1, faults)
        self.assertIn(text, faults[0])

    def test_a_clean_tree_has_no_faults(self):
        self.assertEqual(layering.faults_of(self.root), [])
        self.assertEqual(licences.faults_of(self.root), [])
        self.assertEqual(registered.faults_of(self.root), [])
        self.assertEqual(headers_alone.faults_of(self.root, COMPILER, []), [])
        self.assertEqual(format_check.faults_of(self.root, CLANG_FORMAT), [])

    def test_an_arrow_the_wrong_way(self):
        self.write("cfd_lib/src/a.cpp", BSD + "#include <granflux/coupling/b.hpp>\n")
        self.assert_one_fault(layering.faults_of(self.root), "cfd_lib/src/a.cpp:3")

    def test_a_host_header_in_a_library(self):
        self.write("coupling/src/b.cpp", BSD + '#include "fix_nve.h"\n')
        self.assert_one_fault(layering.faults_of(self.root), "host's header")

    def test_a_header_of_the_other_host(self):
        self.write("liggghts_plugin/lammps/a.cpp", GPL + "#include <lammps/fix.h>\n")
        self.write("liggghts_plugin/driver/a.cpp", GPL + "#include <string>\n")
        self.assertEqual(layering.faults_of(self.root), [])
        self.write("liggghts_plugin/lammps/a.cpp", GPL + "#include <liggghts/fix.h>\n")
        self.assert_one_fault(layering.faults_of(self.root), "lammps may not see")
        self.write("liggghts_plugin/lammps/a.cpp", GPL)
        self.write("liggghts_plugin/driver/a.cpp", GPL + "#include <lammps/fix.h>\n")
        self.assert_one_fault(layering.faults_of(self.root), "driver may not see")

    def test_a_file_of_another_folder(self):
        self.write("cfd_lib/src/a.cpp", BSD + '#include "../../coupling/src/b.cpp"\n')
        self.assert_one_fault(layering.faults_of(self.root), "outside cfd_lib")

    def test_a_solver_library_in_a_public_header(self):
        self.write("cfd_lib/include/a.hpp", BSD + "#include <Eigen/Dense>\n")
        self.assert_one_fault(layering.faults_of(self.root), "public headers")

    def test_the_wrong_licence(self):
        self.write("cfd_lib/src/a.cpp", GPL)
        self.assert_one_fault(licences.faults_of(self.root), "BSD-3-Clause")
        self.write("cfd_lib/src/a.cpp", BSD)
        self.write("liggghts_plugin/c.cpp", BSD)
        self.assert_one_fault(licences.faults_of(self.root), "GPL-2.0-or-later")

    def test_a_file_without_a_licence(self):
        self.write("tests/x.py", "print()\n")
        self.assertEqual(len(licences.faults_of(self.root)), 2)

    def test_an_orphaned_test(self):
        self.write("tests/cfd/CMakeLists.txt", BSD + "# test_x.cpp\n")
        self.write("tests/cfd/test_x.cpp", BSD)
        self.assert_one_fault(registered.faults_of(self.root), "tests/cfd/test_x.cpp")

    def test_a_public_header_outside_the_file_set(self):
        self.write("cfd_lib/include/z.hpp", BSD)
        self.assert_one_fault(registered.faults_of(self.root), "cfd_lib/include/z.hpp")

    def test_a_header_that_leans_on_another(self):
        self.write("coupling/include/granflux/b.hpp", BSD + "std::string b();\n")
        self.assert_one_fault(headers_alone.faults_of(self.root, COMPILER, []), "granflux/b.hpp")
        self.write("coupling/src/b.cpp", BSD + "#include <granflux/b.hpp>\n")  # the build will tell
        self.assertEqual(headers_alone.faults_of(self.root, COMPILER, []), [])

    def test_a_link_that_leads_nowhere(self):
        page = "# A page\n\n[here](#a-page) [there](sub/other.md#two-words) [web](https://example.org)\n`[not](one)`\n"
        self.write("page.md", page)
        self.write("sub/other.md", "## Two words\n")
        self.assertEqual(links.faults_of(self.root), [])
        self.write("sub/other.md", "## Three words\n")
        self.assert_one_fault(links.faults_of(self.root), "no such heading")
        (self.root / "sub/other.md").unlink()
        self.assert_one_fault(links.faults_of(self.root), "no such file")

    def test_a_keyword_that_page_or_program_lacks(self):
        tables = [("page.md", "keyword", ["a.cpp"], keywords.list_of_keywords)]
        self.write("a.cpp", BSD + 'keywords{"one", "two"};\n')
        table = "| keyword | value |\n| --- | --- |\n| `one` | x |\n| `two` | x |\n"
        self.write("docs/reference/page.md", table)
        self.assertEqual(keywords.faults_of(self.root, tables), [])
        self.write("docs/reference/page.md", table + "| `three` | x |\n")
        self.assert_one_fault(keywords.faults_of(self.root, tables), "three is unknown")
        self.write("docs/reference/page.md", table.replace("two", "one"))
        self.assert_one_fault(keywords.faults_of(self.root, tables), "two is not in")

    def test_a_command_that_cannot_be_given(self):
        self.write("CMakePresets.json", '{"configurePresets": [{"name": "release"}]}')
        self.write("tests/meta/commands.txt", "mpirun -n 2 a -> too long\n")
        self.write("page.md", "    cmake --preset release\n    mpirun -n 2 a  # so\n\n    ./run [NAME]\n")

        def check():
            return commands.faults_of(self.root, self.root, "false")

        self.assertEqual(check(), [])
        self.write("page.md", "    cmake --preset other\n    mpirun -n 2 a\n")
        self.assert_one_fault(check(), "no preset other")
        self.write("page.md", "    mpirun -n 2 a\n    ./run nothing\n")
        self.assert_one_fault(check(), "no example nothing")
        self.write("page.md", "    mpirun -n 2 a\n\n```sh\nctest -R none\n```\n")
        self.assert_one_fault(check(), "no test is called none")
        self.write("page.md", "    mpirun -n 2 a\n    granflux -in in.b\n")
        self.assert_one_fault(check(), "neither checked nor")
        self.write("page.md", "text\n")
        self.assert_one_fault(check(), "on no page")

    def test_a_command_that_is_run_and_fails(self):
        self.write("CMakePresets.json", '{"configurePresets": []}')
        self.write("tests/meta/commands.txt", "mkdir a && cd a -> runs\ncp ../in.b ../c . -> runs after touch ../c\n")
        page = "`in.b`, a file\nof two:\n\n```\none\n```\n\n    mkdir a && cd a\n    cp ../in.b ../c .\n"
        self.write("page.md", page)
        self.assertEqual(commands.faults_of(self.root, self.root, "false"), [])
        self.write("page.md", page.replace("`in.b`", "`in.a`"))
        self.assert_one_fault(commands.faults_of(self.root, self.root, "false"), "../in.b")

    def test_a_script_that_cannot_be_run(self):
        (self.root / "run").chmod(0o644)
        self.assert_one_fault(registered.faults_of(self.root), "run: not executable")

    def test_a_file_out_of_format(self):
        self.write("cfd_lib/src/a.cpp", BSD + "int   a;\n")
        self.assert_one_fault(format_check.faults_of(self.root, CLANG_FORMAT), "a.cpp")


if __name__ == "__main__":
    unittest.main()
