"""Chapter 4 of Playter (1994)."""
