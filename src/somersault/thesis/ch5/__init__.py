"""Chapter 5 of Playter (1994)."""
