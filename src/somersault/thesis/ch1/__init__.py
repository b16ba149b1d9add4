"""Chapter 1 of Playter (1994)."""
