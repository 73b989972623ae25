"""What the report's page offers, and the test that proves it: a row that loses its test is found here.

Tests are those of report_browser_test.py and report_numbers_test.py (in a real browser) and of report_test.py.
"""
import pathlib
import re
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROWS = {
    "one file, offline": ["the_file_asks_for_nothing"],
    "float pixels": ["values_are_the_halves_of_their_scaled_selves", "pixels_are_those_of_the_pictures"],
    "flip by key": ["pictures_flip_and_split"],
    "a split slider": ["pictures_flip_and_split"],
    "side by side, pan and zoom locked": ["zoom_and_place_are_the_same_in_all_panes"],
    "exposure": ["exposure_and_colours_are_those_of_their_formulas"],
    "false colour with a scale bar": ["exposure_and_colours_are_those_of_their_formulas"],
    "signed error": ["an_error_maps_mean_is_the_records_rmse", "exposure_and_colours_are_those_of_their_formulas"],
    "error map of any pair": ["a_map_of_two_methods_is_their_difference", "a_map_has_the_references_picture_beside_it"],
    "formula and epsilon beside numbers": ["formula_and_epsilon_are_printed"],
    "probe beside the reference and its error": ["a_click_probes_a_pixel_beside_the_reference"],
    "convergence of a pixel": ["a_click_probes_a_pixel_beside_the_reference"],
    "convergence of a region": ["a_drawn_region_converges"],
    "log-log plots, intervals, hover, lines": ["hovering_a_point_tells_its_numbers", "lines_are_toggled", "plots_have_their_legends",
                                               "intervals_are_drawn_at_their_ends", "cells_have_means_and_students_intervals"],
    "fitted slopes": ["slopes_are_those_of_powers"],
    "distribution linked to the map": ["a_bar_of_the_distribution_marks_its_pixels"],
    "bias and variance maps": ["bias_and_variance_over_seeds_are_those_of_the_pictures"],
    "error spectrum": ["the_spectrum_adds_up_to_the_mean_square", "the_transform_is_that_of_a_wave"],
    "FLIP": ["flip_is_a_map", "flip_maps_are_kept_beside_their_pictures", "flip_is_there_where_its_column_is_filled"],
    "table sorts, filters, marks ties": ["the_table_sorts_and_filters", "records_are_shown_to_the_last_digit"],
    "command and hash by a click": ["commands_and_hashes_are_copied", "the_clipboard_gets_the_text", "each_picture_has_its_command_and_hash"],
    "a state that is a link": ["a_link_brings_the_state_back"],
    "strip and plots as SVG": ["plots_and_strip_are_whole_svg_files", "equal_time_follows_the_time_allowed"],
    "keyboard, print, themes, second signs": ["it_is_used_by_keyboard_alone", "themes_and_print", "no_colour_is_without_a_second_sign", "nothing_is_wider_than_the_window"],
    # Beyond the list
    "nothing stale under a new name": ["nothing_of_another_scene_stands_under_the_new_name", "what_is_stale_is_dimmed_before_anything_is_computed",
                                       "a_part_that_takes_long_is_dimmed_in_the_same_scene"],
    "the wheel scrolls, with Ctrl it zooms": ["the_wheel_over_a_picture_scrolls_the_page", "the_wheel_with_control_zooms_about_the_pointer"],
    "keys on the screen": ["the_keys_are_shown_on_the_screen"],
    "a fault of 1 % in any number": ["a_fault_of_one_percent_is_noticed_in_every_number"],
    "indirect light": ["indirect_light_is_shown_and_scored_alone", "indirect_light_is_a_layer_of_its_own"],
    "holes with their reason": ["a_missing_picture_is_a_hole_with_its_reason", "missing_and_damaged_pictures_are_holes", "a_missing_reference_is_a_hole"],
    "LaTeX and CSV": ["tables", "every_button_does_something"],
}


class Rows(unittest.TestCase):
    def test_each_has_its_tests(self):
        text = "".join((HERE / name).read_text(encoding="utf-8") for name in ("report_test.py", "report_browser_test.py", "report_numbers_test.py"))
        kept = set(re.findall(r"    def test_(\w+)\(self\)", text))
        for row, names in ROWS.items():
            with self.subTest(row):
                self.assertTrue(names)
                self.assertEqual(set(names) - kept, set())


if __name__ == "__main__":
    unittest.main()
