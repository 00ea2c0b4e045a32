"""The tutorials lead to their answers."""

from guide import Guide


class Tutorials(Guide):
    def test_the_tutorial_about_a_study_leads_to_its_answer(self):
        names = ("first-study/effects/effects.html", "first-study/results.csv", "first-study/optimum/profiler.svg", "wear-rate/fit/keys.csv")
        self.expect_tutorial("tutorial-study.md", *names, warns=True)

    def test_the_tutorial_about_a_surface_leads_to_its_ring(self):
        self.expect_tutorial("tutorial-surface.md", "disc.png", "ring.png", "measured.h5", "finer.h5", "extended-3.h5")

    def test_the_tutorial_about_a_drive_leads_to_its_answer(self):
        self.expect_tutorial("tutorial-drive.md", "city-events.csv", "drives/emission.png", "drives/temperature.png")

    def test_the_tutorial_about_clusters_loses_nothing_that_is_killed(self):
        self.expect_tutorial("tutorial-cluster.md", "loads.sbatch", "loads/results.h5")
        table = (self.folder / "own/loads/results.csv").read_text()
        self.assertEqual(sum(",finished," in line for line in table.splitlines()[1:]), 24)
